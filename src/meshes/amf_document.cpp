#include "meshes/amf_document.hpp"

#include "container/decimal_text.hpp"
#include "container/plain_values.hpp"
#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/lower_case.hpp"
#include "meshes/mesh_document.hpp"
#include "meshes/slicer_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t longest_label = 200;
constexpr std::size_t longest_title = 1000;
constexpr std::size_t longest_text = 1U << 16; ///< of elements that are read

struct Unit {
    std::string_view name; ///< in lower case
    double mm;
};

/// Units of the standard, and others that occur in files.
constexpr std::array units = {
    Unit{"millimeter", 1},
    Unit{"inch", 25.4},
    Unit{"feet", 304.8},
    Unit{"meter", 1000},
    Unit{"micron", 0.001},
    Unit{"millimeters", 1},
    Unit{"millimetre", 1},
    Unit{"millimetres", 1},
    Unit{"mm", 1},
    Unit{"centimeter", 10},
    Unit{"centimeters", 10},
    Unit{"centimetre", 10},
    Unit{"centimetres", 10},
    Unit{"cm", 10},
    Unit{"inches", 25.4},
    Unit{"in", 25.4},
    Unit{"foot", 304.8},
    Unit{"ft", 304.8},
    Unit{"meters", 1000},
    Unit{"metre", 1000},
    Unit{"metres", 1000},
    Unit{"m", 1000},
    Unit{"micrometer", 0.001},
    Unit{"micrometers", 0.001},
    Unit{"micrometre", 0.001},
    Unit{"micrometres", 0.001},
    Unit{"microns", 0.001},
    Unit{"um", 0.001},
    Unit{"\xc2\xb5m", 0.001},
    Unit{"\xce\xbcm", 0.001},
};

std::size_t read_vertices(XmlCursor& tags, std::size_t, std::span<Point3> vertices) {
    return take_items(tags, vertices, [&](Point3& v) {
        return tags.take("<vertex>") && tags.take("<coordinates>") && tags.take("<x>") &&
               take_value(tags, v.x) && tags.take("</x>") && tags.take("<y>") && take_value(tags, v.y) &&
               tags.take("</y>") && tags.take("<z>") && take_value(tags, v.z) && tags.take("</z>") &&
               tags.take("</coordinates>") && tags.take("</vertex>");
    });
}

std::size_t read_triangles(XmlCursor& tags, std::size_t vertices, std::span<TriangleIndices> triangles) {
    return take_items(tags, triangles, [&](TriangleIndices& t) {
        return tags.take("<triangle>") && tags.take("<v1>") && take_value(tags, t[0]) && tags.take("</v1>") &&
               tags.take("<v2>") && take_value(tags, t[1]) && tags.take("</v2>") && tags.take("<v3>") &&
               take_value(tags, t[2]) && tags.take("</v3>") && tags.take("</triangle>") &&
               std::max({t[0], t[1], t[2]}) < vertices;
    });
}

constexpr MeshTextForm text_form{{"<vertex", "</vertices", read_vertices},
                                 {"<triangle", "</volume", read_triangles}};

/// Names of the numbers of an instance.
constexpr std::array<std::string_view, 14> instance_numbers = {
    "deltax", "deltay", "deltaz", "rx",      "ry",      "rz",      "scale",
    "scalex", "scaley", "scalez", "mirrorx", "mirrory", "mirrorz", "printable"};

/// Element that contains the current one.
enum class AmfTag {
    outside,
    amf,
    object,
    mesh,
    vertices,
    vertex,
    coordinates,
    triangles, ///< of a volume
    triangle,
    constellation,
    instance,
    number,   ///< of a vertex, triangle or instance
    metadata, ///< of the file, an object or a constellation
    elsewhere ///< in an element that is skipped
};

struct AmfElement {
    std::string_view name;
    const XmlAttributes& attributes;

    /// Returns an attribute without the blanks around it.
    std::string_view operator[](std::string_view attribute) const {
        return trimmed(attributes.find(attribute));
    }
};

class AmfDocumentReader final : MeshDocumentReader<AmfDocument, AmfTag> {
  public:
    AmfDocumentReader(const std::string& name, Executor& executor, ReadLimits& limits)
        : MeshDocumentReader(name, "", executor, limits) {}

    AmfDocument read(std::string_view text, const std::function<void(std::size_t)>& progress) {
        XmlHandlers handlers;
        handlers.text = [this](std::string_view chunk) {
            if ((in() == Where::number || in() == Where::metadata) && text_.size() < longest_text)
                text_ += chunk;
        };
        handlers.progress = progress;
        parse(text, text_form, std::move(handlers));
        return take();
    }

  private:
    using Where = AmfTag;
    using Step = Where (AmfDocumentReader::*)(const AmfElement&);

    static const auto& rules() {
        using Self = AmfDocumentReader;
        static constexpr auto all = std::to_array<ElementRule<Where, Step>>(
            {{Where::vertices, "vertex", &Self::is<Where::vertex>},
             {Where::vertex, "coordinates", &Self::is<Where::coordinates>},
             {Where::coordinates, "x", &Self::start_number},
             {Where::coordinates, "y", &Self::start_number},
             {Where::coordinates, "z", &Self::start_number},
             {Where::triangles, "triangle", &Self::is<Where::triangle>},
             {Where::triangle, "v1", &Self::start_number},
             {Where::triangle, "v2", &Self::start_number},
             {Where::triangle, "v3", &Self::start_number},
             {Where::vertices, "edge", &Self::pass_over_bend},
             {Where::vertex, "normal", &Self::pass_over_bend},
             {Where::amf, "object", &Self::start_object},
             {Where::amf, "constellation", &Self::start_constellation},
             {Where::amf, "metadata", &Self::start_metadata},
             {Where::object, "mesh", &Self::start_mesh},
             {Where::object, "metadata", &Self::start_metadata},
             {Where::mesh, "vertices", &Self::is<Where::vertices>},
             {Where::mesh, "volume", &Self::start_volume},
             {Where::triangles, "metadata", &Self::start_metadata},
             {Where::constellation, "instance", &Self::start_instance},
             {Where::constellation, "metadata", &Self::start_metadata}});
        return all;
    }

    Where start(XmlName name, const XmlAttributes& attributes) override {
        const AmfElement element{name.local, attributes};
        if (in() == Where::outside)
            return start_file(element);
        if (in() == Where::instance &&
            std::find(instance_numbers.begin(), instance_numbers.end(), name.local) != instance_numbers.end())
            return start_number(element);
        if (in() == Where::number)
            fail(fmt::format("found <{}> in <{}>, expected a number", printable(name.local, 40), kind_));
        const Step step = step_for(rules(), in(), name.local);
        return step != nullptr ? (this->*step)(element) : Where::elsewhere;
    }

    template <AmfTag what>
    Where is(const AmfElement&) {
        return what;
    }

    Where start_file(const AmfElement& element) {
        if (lower_case(element.name) != "amf")
            fail(fmt::format("found <{}>, expected <amf>", printable(element.name, 40)));
        if (const std::string_view unit = element.attributes.find("unit"); unit.data() != nullptr) {
            const std::string name = lower_case(trimmed(unit));
            const auto* const known =
                std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.name == name; });
            if (known == units.end())
                fail(fmt::format("found unit '{}', expected millimeter, inch, feet, meter or micron",
                                 printable(unit, 40)));
            document().unit_mm = known->mm;
        }
        return Where::amf;
    }

    Where start_object(const AmfElement& element) {
        append(document().objects, AmfObject{required(element, "id"), {}, line(), false, {}, {}});
        return Where::object;
    }

    Where start_mesh(const AmfElement&) {
        if (std::exchange(object().has_mesh, true))
            fail("found a second <mesh> in an object, expected one");
        return Where::mesh;
    }

    Where start_volume(const AmfElement& element) {
        const MeshRole role = lower_case(element["type"]) == "support" ? MeshRole::support : MeshRole::part;
        append(object().volumes, VolumeRange{object().mesh.triangles.size(), 0, role});
        return Where::triangles;
    }

    Where pass_over_bend(const AmfElement&) {
        document().bent.note(line());
        return Where::elsewhere;
    }

    Where start_constellation(const AmfElement& element) {
        append(document().constellations, AmfConstellation{required(element, "id"), {}, line(), {}});
        return Where::constellation;
    }

    Where start_instance(const AmfElement& element) {
        append(constellation().instances, AmfInstance{required(element, "objectid"), line(), {}});
        return Where::instance;
    }

    Where start_metadata(const AmfElement& element) {
        // Only Slic3r and its descendants write this word, and they write angles in radians.
        const std::string type = lower_case(element["type"]);
        document().radians = document().radians || type.starts_with("slic3r");
        begin_text(type);
        return Where::metadata;
    }

    Where start_number(const AmfElement& element) {
        begin_text(element.name);
        return Where::number;
    }

    void begin_text(std::string_view of) {
        kind_ = of;
        text_.clear();
    }

    void end(Where ended) override {
        switch (ended) {
        case Where::number:
            end_number(trimmed(text_));
            break;
        case Where::metadata:
            end_metadata(trimmed(text_));
            break;
        case Where::triangles:
            object().volumes.back().end = object().mesh.triangles.size();
            break;
        case Where::vertex:
            if (std::exchange(seen_, 0) != all_three)
                fail("found a vertex without all of x, y and z");
            add(Point3{point_[0], point_[1], point_[2]});
            break;
        case Where::triangle:
            if (std::exchange(seen_, 0) != all_three)
                fail("found a triangle without all of v1, v2 and v3");
            add(corners_);
            break;
        default:
            break;
        }
    }

    void end_number(std::string_view text) {
        if (in() == Where::triangle) {
            const auto corner = static_cast<std::size_t>(kind_[1] - '1');
            corners_[corner] = vertex_of(text);
            see(corner);
        } else if (in() == Where::coordinates) {
            const auto axis = static_cast<std::size_t>(kind_[0] - 'x');
            point_[axis] = number_of(text);
            see(axis);
        } else {
            count(node_bytes);
            constellation().instances.back().numbers[kind_] = number_of(text);
        }
    }

    std::uint32_t vertex_of(std::string_view text) {
        std::uint32_t vertex = 0;
        require_end(read_index(text.data(), text.data() + text.size(), vertex), text, "a whole number");
        if (const std::size_t known = object().mesh.vertices.size(); vertex >= known)
            fail(fmt::format("found {} = {}, expected less than {}, the number of vertices before it", kind_,
                             vertex, known));
        return vertex;
    }

    double number_of(std::string_view text) const {
        double number = 0;
        require_end(read_decimal(text.data(), text.data() + text.size(), number), text,
                    "a number with a decimal point");
        if (!(std::abs(number) <= farthest_coordinate))
            fail(fmt::format("found {} in <{}>, expected a number within {}", printable(text, 40), kind_,
                             farthest_coordinate));
        return number;
    }

    void require_end(const char* stop, std::string_view text, std::string_view expected) const {
        if (text.empty() || stop != text.data() + text.size())
            fail(fmt::format("found '{}' in <{}>, expected {}", printable(text, 40), kind_, expected));
    }

    void see(std::size_t index) {
        if ((seen_ >> index & 1) != 0)
            fail(fmt::format("found a second <{}>, expected one", kind_));
        seen_ |= 1U << index;
    }

    void end_metadata(std::string_view text) {
        if (in() == Where::amf && kind_ == "cad") {
            const std::string program = lower_case(text);
            document().radians = document().radians || program.find("slic3r") != std::string::npos ||
                                 program.find("prusa") != std::string::npos;
        }
        if (in() == Where::triangles) {
            VolumeRange& volume = object().volumes.back();
            if (kind_ == "name")
                volume.name = printable(text, longest_label);
            else if (kind_ == "slic3r.volume_type")
                volume.role = slicer_role(text).value_or(volume.role);
            else if (kind_ == "slic3r.modifier" && text == "1" && volume.role == MeshRole::part)
                volume.role = MeshRole::modifier;
            return;
        }
        if (kind_ != "name")
            return;
        if (in() == Where::amf)
            document().name = printable(text, longest_title);
        else if (in() == Where::object)
            object().name = printable(text, longest_label);
        else
            constellation().name = printable(text, longest_label);
    }

    std::string required(const AmfElement& element, std::string_view attribute) {
        const std::string_view text = element[attribute];
        if (text.empty())
            fail(fmt::format("found an element without {}, expected one", attribute));
        count(text.size());
        return std::string(text);
    }

    AmfConstellation& constellation() { return document().constellations.back(); }

    static constexpr unsigned all_three = 7;

    std::string kind_; ///< element of the current number, or type of the metadata
    std::string text_;
    unsigned seen_ = 0; ///< coordinates or corners read so far
    std::array<double, 3> point_{};
    TriangleIndices corners_{};
};

} // namespace

const MeshTextForm& amf_text_form() noexcept {
    return text_form;
}

AmfDocument read_amf_document(std::string_view document, const std::string& name, Executor& executor,
                              ReadLimits& limits, const std::function<void(std::size_t)>& progress) {
    return AmfDocumentReader(name, executor, limits).read(document, progress);
}

} // namespace lamella
