#include "read/amf_document.hpp"

#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "container/xml.hpp"
#include "core/lower_case.hpp"
#include "read/decimal_text.hpp"
#include "read/read_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t longest_label = 200;
constexpr std::size_t longest_title = 1000;
constexpr std::size_t longest_text = 1U << 16; ///< that anybody reads

struct Unit {
    std::string_view name; ///< in lower case
    double mm;
};

/// The five of the standard, and what else has been seen.
constexpr std::array units = {Unit{"millimeter", 1}, Unit{"inch", 25.4},        Unit{"feet", 304.8},
                              Unit{"meter", 1000},   Unit{"micron", 0.001},     Unit{"millimeters", 1},
                              Unit{"mm", 1},         Unit{"inches", 25.4},      Unit{"foot", 304.8},
                              Unit{"meters", 1000},  Unit{"micrometer", 0.001}, Unit{"micrometers", 0.001},
                              Unit{"microns", 0.001}};

/// Elements without attributes that hold a number or others of their kind.
class PlainTags {
  public:
    explicit PlainTags(std::string_view run) : at_(run.data()), end_(run.data() + run.size()) {}

    bool take(std::string_view tag) {
        skip_blanks();
        if (static_cast<std::size_t>(end_ - at_) < tag.size() ||
            std::memcmp(at_, tag.data(), tag.size()) != 0)
            return false;
        at_ += tag.size();
        return true;
    }

    bool take(double& number) {
        skip_blanks();
        return move(read_decimal(at_, end_, number)) && std::abs(number) <= farthest_coordinate;
    }

    bool take(std::uint32_t& number) {
        skip_blanks();
        return move(read_index(at_, end_, number));
    }

    bool done() {
        skip_blanks();
        return at_ == end_;
    }

  private:
    // Behind the run there is another byte, and it is no blank.
    void skip_blanks() {
        while (*at_ == ' ' || *at_ == '\n' || *at_ == '\r' || *at_ == '\t')
            ++at_;
    }

    bool move(const char* to) {
        at_ = to == nullptr ? at_ : to;
        return to != nullptr;
    }

    const char* at_;
    const char* end_;
};

bool read_vertices(std::string_view run, const MeshText&, std::span<Point3> vertices) {
    PlainTags tags(run);
    for (Point3& v : vertices)
        if (!(tags.take("<vertex>") && tags.take("<coordinates>") && tags.take("<x>") && tags.take(v.x) &&
              tags.take("</x>") && tags.take("<y>") && tags.take(v.y) && tags.take("</y>") &&
              tags.take("<z>") && tags.take(v.z) && tags.take("</z>") && tags.take("</coordinates>") &&
              tags.take("</vertex>")))
            return false;
    return tags.done();
}

bool read_triangles(std::string_view run, const MeshText&, std::span<TriangleIndices> triangles) {
    PlainTags tags(run);
    for (TriangleIndices& t : triangles)
        if (!(tags.take("<triangle>") && tags.take("<v1>") && tags.take(t[0]) && tags.take("</v1>") &&
              tags.take("<v2>") && tags.take(t[1]) && tags.take("</v2>") && tags.take("<v3>") &&
              tags.take(t[2]) && tags.take("</v3>") && tags.take("</triangle>")))
            return false;
    return tags.done();
}

constexpr MeshTextForm text_form{
    {"<vertex", 10,
     std::string_view("<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>").size(),
     read_vertices},
    {"<triangle", 8, std::string_view("<triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle>").size(),
     read_triangles}};

/// What a number of an instance may be called.
constexpr std::array<std::string_view, 14> instance_numbers = {
    "deltax", "deltay", "deltaz", "rx",      "ry",      "rz",      "scale",
    "scalex", "scaley", "scalez", "mirrorx", "mirrory", "mirrorz", "printable"};

class DocumentReader {
  public:
    DocumentReader(const std::string& name, bool supports, bool skim, ReadLimits& limits)
        : name_(name), supports_(supports), skim_(skim), count_(limits) {}

    AmfDocument read(std::string_view document, const std::function<void(std::size_t)>& progress) {
        XmlHandlers handlers;
        handlers.start = [this](XmlName name, const XmlAttributes& attributes, std::size_t line) {
            line_ = line;
            where_.push_back(start(name.local, attributes));
        };
        handlers.end = [this](XmlName) {
            end();
        };
        handlers.text = [this](std::string_view text) {
            if (wants_text_ && text_.size() < longest_text)
                text_ += text;
        };
        handlers.progress = progress;
        if (skim_) {
            handlers.many = {text_form.vertex.tag, text_form.triangle.tag};
            handlers.skim = [this](std::string_view text, std::size_t place) {
                return skim(text, place);
            };
        }
        parse_xml(document, name_, handlers);
        count_.keep(here());
        return std::move(result_);
    }

  private:
    enum class Where {
        amf,
        object,
        mesh,
        vertices,
        vertex,
        coordinates,
        volume,
        triangle,
        constellation,
        instance,
        number,   ///< of a vertex, triangle or instance
        metadata, ///< of the file, an object or a constellation
        elsewhere ///< in something that is passed over
    };

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::input, fmt::format("{}, line {}: {}", name_, line_, what));
    }

    [[nodiscard]] std::string here() const { return fmt::format("line {}", line_); }

    /// To be called before memory is taken.
    void count(std::uint64_t triangles, std::uint64_t bytes) {
        count_.add(triangles, bytes, [this] { return here(); });
    }

    Where start(std::string_view element, const XmlAttributes& attributes) {
        if (where_.empty())
            return start_file(element, attributes);
        const Where in = where_.back();
        if (element == "metadata" && (in == Where::amf || in == Where::object || in == Where::constellation))
            return start_metadata(attributes);
        switch (in) {
        case Where::amf:
            if (element == "object")
                return start_object(attributes);
            if (element == "constellation") {
                count(0, sizeof(AmfConstellation));
                result_.constellations.push_back({std::string(required(attributes, "id")), {}, line_, {}});
                return Where::constellation;
            }
            break;
        case Where::object:
            if (element == "mesh") {
                if (std::exchange(object().has_mesh, true))
                    fail("found a second <mesh> in an object, expected one");
                return Where::mesh;
            }
            break;
        case Where::mesh:
            if (element == "vertices")
                return Where::vertices;
            if (element == "volume") {
                const bool support = lower_case(trimmed(attributes.find("type"))) == "support";
                object().has_part = object().has_part || !support;
                if (supports_ || !support)
                    return Where::volume;
                result_.supports.note(line_);
            }
            break;
        case Where::vertices:
            if (element == "vertex") {
                require_all_by_parser();
                seen_ = 0;
                return Where::vertex;
            }
            if (element == "edge")
                result_.bent.note(line_);
            break;
        case Where::vertex:
            if (element == "coordinates")
                return Where::coordinates;
            if (element == "normal")
                result_.bent.note(line_);
            break;
        case Where::coordinates:
            if (element == "x" || element == "y" || element == "z")
                return start_number(element);
            break;
        case Where::volume:
            if (element == "triangle") {
                require_all_by_parser();
                seen_ = 0;
                return Where::triangle;
            }
            break;
        case Where::triangle:
            if (element == "v1" || element == "v2" || element == "v3")
                return start_number(element);
            break;
        case Where::constellation:
            if (element == "instance") {
                count(0, sizeof(AmfInstance));
                result_.constellations.back().instances.push_back(
                    {std::string(required(attributes, "objectid")), line_, {}});
                return Where::instance;
            }
            break;
        case Where::instance:
            if (std::find(instance_numbers.begin(), instance_numbers.end(), element) !=
                instance_numbers.end())
                return start_number(element);
            break;
        default:
            break;
        }
        return Where::elsewhere;
    }

    void end() {
        const Where ended = where_.back();
        where_.pop_back();
        switch (ended) {
        case Where::number:
            end_number();
            break;
        case Where::metadata:
            end_metadata();
            break;
        case Where::vertex:
            if (seen_ != all_three)
                fail("found a vertex without all of x, y and z");
            count(0, sizeof(Point3));
            object().mesh.vertices.push_back({point_[0], point_[1], point_[2]});
            break;
        case Where::triangle:
            if (seen_ != all_three)
                fail("found a triangle without all of v1, v2 and v3");
            count(1, sizeof(TriangleIndices));
            object().mesh.triangles.push_back(corners_);
            break;
        default:
            break;
        }
    }

    Where start_file(std::string_view element, const XmlAttributes& attributes) {
        if (lower_case(element) != "amf")
            fail(fmt::format("found <{}>, expected <amf>", printable(element, 40)));
        if (const std::string_view unit = attributes.find("unit"); unit.data() != nullptr) {
            const std::string name = lower_case(trimmed(unit));
            const auto* const known =
                std::find_if(units.begin(), units.end(), [&](const Unit& u) { return u.name == name; });
            if (known == units.end())
                fail(fmt::format("found unit '{}', expected millimeter, inch, feet, meter or micron",
                                 printable(unit, 40)));
            result_.unit_mm = known->mm;
        }
        return Where::amf;
    }

    Where start_object(const XmlAttributes& attributes) {
        count(0, sizeof(AmfObject));
        result_.objects.push_back({std::string(required(attributes, "id")), {}, line_, false, false, {}, {}});
        return Where::object;
    }

    Where start_metadata(const XmlAttributes& attributes) {
        kind_ = lower_case(trimmed(attributes.find("type")));
        // Only Slic3r and its descendants leave such words, and they write radians.
        result_.radians = result_.radians || kind_.starts_with("slic3r");
        begin_text();
        return Where::metadata;
    }

    void end_metadata() {
        wants_text_ = false;
        const std::string_view text = trimmed(text_);
        const Where in = where_.back();
        if (in == Where::amf && kind_ == "cad") {
            const std::string program = lower_case(text);
            result_.radians = result_.radians || program.find("slic3r") != std::string::npos ||
                              program.find("prusa") != std::string::npos;
        }
        if (kind_ != "name")
            return;
        if (in == Where::amf)
            result_.name = printable(text, longest_title);
        else if (in == Where::object)
            object().name = printable(text, longest_label);
        else
            result_.constellations.back().name = printable(text, longest_label);
    }

    Where start_number(std::string_view element) {
        kind_ = element;
        begin_text();
        return Where::number;
    }

    void end_number() {
        wants_text_ = false;
        const std::string_view text = trimmed(text_);
        const char* const first = text.data();
        const char* const last = first + text.size();
        const auto expect = [&](const char* stop, std::string_view what) {
            if (text.empty() || stop != last)
                fail(fmt::format("found '{}' in <{}>, expected {}", printable(text, 40), kind_, what));
        };
        const Where in = where_.back();
        if (in == Where::triangle) {
            const auto corner = static_cast<std::size_t>(kind_[1] - '1');
            expect(read_index(first, last, corners_[corner]), "a whole number");
            if (corners_[corner] >= object().mesh.vertices.size())
                fail(fmt::format("found {} = {}, expected less than {}, the number of vertices before it",
                                 kind_, corners_[corner], object().mesh.vertices.size()));
            see(corner);
            return;
        }
        double number = 0;
        expect(read_decimal(first, last, number), "a number with a decimal point");
        if (!(std::abs(number) <= farthest_coordinate))
            fail(fmt::format("found {} in <{}>, expected a number within {}", printable(text, 40), kind_,
                             farthest_coordinate));
        if (in == Where::coordinates) {
            const auto axis = static_cast<std::size_t>(kind_[0] - 'x');
            point_[axis] = number;
            see(axis);
        } else {
            count(0, node_bytes);
            result_.constellations.back().instances.back().numbers[kind_] = number;
        }
    }

    void see(std::size_t index) {
        if ((seen_ >> index & 1) != 0)
            fail(fmt::format("found a second <{}>, expected one", kind_));
        seen_ |= 1U << index;
    }

    void begin_text() {
        wants_text_ = true;
        text_.clear();
    }

    std::string_view required(const XmlAttributes& attributes, std::string_view name) const {
        const std::string_view text = trimmed(attributes.find(name));
        if (text.empty())
            fail(fmt::format("found an element without {}, expected one", name));
        return text;
    }

    /// Leaves a run of vertices or triangles to others.
    std::size_t skim(std::string_view document, std::size_t place) {
        const Where in = where_.empty() ? Where::elsewhere : where_.back();
        if (in != Where::vertices && in != Where::volume)
            return 0;
        MeshText& text = object().text;
        text.place = here();
        return in == Where::vertices ? take_run(document, place, "</vertices", text.vertices)
                                     : take_run(document, place, "</volume", text.triangles);
    }

    /// Where runs are skimmed no vertex may come past the parser: their order would be lost.
    void require_all_by_parser() const {
        if (skim_)
            fail("found a mesh that is not written plainly");
    }

    AmfObject& object() { return result_.objects.back(); }

    static constexpr unsigned all_three = 7;

    const std::string& name_;
    bool supports_;
    bool skim_;
    GrowingMeshCount count_;
    AmfDocument result_;
    std::size_t line_ = 1;
    std::vector<Where> where_;
    std::string kind_; ///< element of a number, or type of metadata
    std::string text_;
    bool wants_text_ = false;
    unsigned seen_ = 0; ///< which coordinates or corners
    std::array<double, 3> point_{};
    TriangleIndices corners_{};
};

} // namespace

const MeshTextForm& amf_text_form() noexcept {
    return text_form;
}

AmfDocument read_amf_document(std::string_view document, const std::string& name, bool supports, bool skim,
                              ReadLimits& limits, const std::function<void(std::size_t)>& progress) {
    return DocumentReader(name, supports, skim, limits).read(document, progress);
}

} // namespace lamella
