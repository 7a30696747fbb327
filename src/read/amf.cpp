#include "read/amf.hpp"

#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "container/xml.hpp"
#include "container/zip_reader.hpp"
#include "core/executor.hpp"
#include "read/assembly.hpp"
#include "read/decimal_text.hpp"
#include "read/mesh_text.hpp"
#include "read/read_limits.hpp"
#include "read/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <functional>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t longest_preface = 1U << 16;
constexpr std::size_t longest_name = 200;
constexpr std::size_t longest_title = 1000;
constexpr std::size_t longest_text = 1U << 16; ///< that anybody reads
constexpr std::uint64_t node_bytes = 80;       ///< of a map, about

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

std::string lower(std::string_view text) {
    std::string result(text);
    std::transform(result.begin(), result.end(), result.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c | 0x20) : c; });
    return result;
}

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

struct AmfObject {
    std::string id;
    std::string name;
    std::size_t line = 0;
    bool has_mesh = false;
    IndexedMesh mesh;
    MeshText text;
};

struct AmfInstance {
    std::string object;
    std::size_t line = 0;
    std::map<std::string, double, std::less<>> numbers; ///< "deltax", "rx", ...

    [[nodiscard]] double number(std::string_view name, double otherwise) const {
        const auto found = numbers.find(name);
        return found == numbers.end() ? otherwise : found->second;
    }
};

struct AmfConstellation {
    std::string id;
    std::string name;
    std::size_t line = 0;
    std::vector<AmfInstance> instances;
};

/// Oddities of which one wants to know how often they occur, and where first.
struct Counted {
    std::size_t count = 0;
    std::size_t line = 0;

    void note(std::size_t where) {
        if (count++ == 0)
            line = where;
    }
};

struct AmfDocument {
    std::optional<double> unit_mm;
    std::string name;
    bool radians = false;
    std::vector<AmfObject> objects;
    std::vector<AmfConstellation> constellations;
    Counted bent;     ///< edges and normals
    Counted supports; ///< volumes
};

/// What a number of an instance may be called.
constexpr std::array<std::string_view, 14> instance_numbers = {
    "deltax", "deltay", "deltaz", "rx",      "ry",      "rz",      "scale",
    "scalex", "scaley", "scalez", "mirrorx", "mirrory", "mirrorz", "printable"};

class DocumentReader {
  public:
    DocumentReader(const std::string& name, bool skim, ReadLimits& limits)
        : name_(name), skim_(skim), count_(limits) {}

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
                if (lower(trimmed(attributes.find("type"))) != "support")
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
        if (lower(element) != "amf")
            fail(fmt::format("found <{}>, expected <amf>", printable(element, 40)));
        if (const std::string_view unit = attributes.find("unit"); unit.data() != nullptr) {
            const std::string name = lower(trimmed(unit));
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
        result_.objects.push_back({std::string(required(attributes, "id")), {}, line_, false, {}, {}});
        return Where::object;
    }

    Where start_metadata(const XmlAttributes& attributes) {
        kind_ = lower(trimmed(attributes.find("type")));
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
            const std::string program = lower(text);
            result_.radians = result_.radians || program.find("slic3r") != std::string::npos ||
                              program.find("prusa") != std::string::npos;
        }
        if (kind_ != "name")
            return;
        if (in == Where::amf)
            result_.name = printable(text, longest_title);
        else if (in == Where::object)
            object().name = printable(text, longest_name);
        else
            result_.constellations.back().name = printable(text, longest_name);
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

std::string_view view(const ByteSource& source) {
    return {reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size()};
}

class AmfReader {
  public:
    AmfReader(const ByteSource& source, const MeshReadOptions& options, const Execution& execution)
        : name_(source.name), remarks_(source.name, options.strict), limits_(source.name, options),
          execution_(execution), executor_(execution) {
        source_ = is_zip(view(source)) ? unpacked(source, options) : source;
    }

    MeshFile read() {
        read_document();
        make_nodes();
        make_file();
        file_.format = MeshFormat::amf;
        file_.unit_mm = document_.unit_mm;
        file_.name = !document_.name.empty() ? document_.name : file_.objects.front().name;
        file_.warnings = remarks_.take();
        file_.warnings.insert(file_.warnings.end(), notes_.begin(), notes_.end());
        return std::move(file_);
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::input, fmt::format("{}: {}", name_, what));
    }

    ByteSource unpacked(const ByteSource& archive, const MeshReadOptions& options) {
        const ZipReader zip(archive, options.max_memory);
        for (const std::string& oddity : zip.oddities())
            remarks_.add(oddity);
        const ZipEntry* found = nullptr;
        std::size_t count = 0;
        for (const ZipEntry& entry : zip.entries())
            if (lower(entry.name).ends_with(".amf") || lower(entry.name).ends_with(".amf.xml")) {
                ++count;
                found = found == nullptr ? &entry : found;
            }
        if (found == nullptr && zip.entries().size() == 1)
            found = &zip.entries().front();
        if (found == nullptr)
            fail(fmt::format("is a zip archive of {} files, expected one whose name ends in .amf",
                             zip.entries().size()));
        if (count > 1)
            remarks_.add(fmt::format("the archive holds {} AMF files; took the first, '{}'", count,
                                     printable(found->name, longest_name)));
        ByteSource part = zip.read(*found);
        limits_.add_bytes(zip.unpacked());
        return part;
    }

    void read_document() {
        const std::string_view text = view(source_);
        ProgressMeter progress(execution_, Stage::read, text.size());
        try {
            document_ = DocumentReader(source_.name, true, limits_).read(text, [&](std::size_t read) {
                executor_.check_cancelled();
                progress.add(read);
            });
            progress.finish();
        } catch (const Error& error) {
            if (error.kind() != ErrorKind::input)
                throw;
            // It may be at fault, or only be written in a way that is no good for skimming.
            read_by_parser();
        }
        std::vector<MeshText> texts;
        std::vector<AmfObject*> owners;
        for (AmfObject& object : document_.objects)
            if (!object.text.vertices.empty() || !object.text.triangles.empty()) {
                texts.push_back(object.text);
                owners.push_back(&object);
            }
        std::vector<std::optional<IndexedMesh>> meshes =
            read_mesh_texts(texts, text_form, limits_, executor_);
        if (std::all_of(meshes.begin(), meshes.end(), [](const auto& mesh) { return mesh.has_value(); })) {
            for (std::size_t i = 0; i < meshes.size(); ++i)
                owners[i]->mesh = std::move(*meshes[i]);
        } else {
            for (const std::optional<IndexedMesh>& mesh : meshes)
                if (mesh)
                    give_back(*mesh, limits_);
            meshes.clear();
            read_by_parser();
        }
        source_.bytes = {};
        source_.owner.reset();
    }

    void read_by_parser() {
        document_ = DocumentReader(source_.name, false, limits_).read(view(source_), [&](std::size_t) {
            executor_.check_cancelled();
        });
    }

    /// Objects and constellations are nodes alike; ids count for both.
    void make_nodes() {
        const double unit = document_.unit_mm.value_or(1);
        const auto add = [&](const std::string& id, const std::string& name, std::size_t line,
                             std::string_view what) {
            const std::string place =
                fmt::format("line {}: {} '{}'", line, what, printable(id, longest_name));
            if (!numbers_.emplace(id, nodes_.size()).second)
                fail(fmt::format("{}: the id is there for the second time", place));
            nodes_.push_back({name, {}, scaling(unit, unit, unit), {}, place});
        };
        for (const AmfObject& object : document_.objects)
            add(object.id, object.name, object.line, "object");
        for (const AmfConstellation& constellation : document_.constellations)
            add(constellation.id, constellation.name, constellation.line, "constellation");
        std::vector<bool> used(nodes_.size());
        for (std::size_t i = 0; i < document_.constellations.size(); ++i) {
            AssemblyNode& node = nodes_[document_.objects.size() + i];
            for (const AmfInstance& instance : document_.constellations[i].instances) {
                const std::string place = fmt::format("line {}: this instance", instance.line);
                const auto target = numbers_.find(instance.object);
                if (target == numbers_.end())
                    fail(fmt::format("line {}: found objectid '{}', but there is nothing of that id",
                                     instance.line, printable(instance.object, longest_name)));
                used[target->second] = true;
                if (instance.number("printable", 1) == 0) {
                    ++not_printable_;
                    continue;
                }
                node.uses.push_back({target->second, placement(instance, unit), place});
            }
        }
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (!used[i])
                roots_.push_back({i, {}, nodes_[i].place});
        if (roots_.empty() && !nodes_.empty())
            fail("each constellation is a part of another, expected one that is not");
    }

    /// Scaled, mirrored, turned about x, then y, then z, and moved.
    [[nodiscard]] Transform placement(const AmfInstance& instance, double unit) const {
        const double scale = instance.number("scale", 1);
        const auto factor = [&](std::string_view axis_scale, std::string_view mirror) {
            return scale * instance.number(axis_scale, 1) * (instance.number(mirror, 1) < 0 ? -1 : 1);
        };
        Transform map =
            scaling(factor("scalex", "mirrorx"), factor("scaley", "mirrory"), factor("scalez", "mirrorz"));
        if (!(std::abs(map.determinant()) > 0) || !finite(map))
            fail(fmt::format("line {}: found a scale of 0 or beyond all bounds", instance.line));
        for (const char axis : {'x', 'y', 'z'}) {
            const double angle = instance.number(fmt::format("r{}", axis), 0);
            map = compose(rotation(axis, document_.radians ? angle * 180 / std::numbers::pi : angle), map);
        }
        return compose(translation(instance.number("deltax", 0) * unit, instance.number("deltay", 0) * unit,
                                   instance.number("deltaz", 0) * unit),
                       map);
    }

    void make_file() {
        std::size_t empty = 0;
        std::size_t degenerate = 0;
        for (std::size_t i = 0; i < document_.objects.size(); ++i) {
            AmfObject& object = document_.objects[i];
            if (object.mesh.triangles.empty()) {
                ++empty;
                continue;
            }
            degenerate += degenerate_triangles(object.mesh);
            nodes_[i].object = file_.objects.size();
            file_.stored_triangles += object.mesh.triangles.size();
            file_.objects.push_back({object.name, Mesh(std::move(object.mesh))});
        }
        if (empty != 0)
            remarks_.add(fmt::format("{} objects have no triangle", empty));
        if (degenerate != 0)
            remarks_.add(fmt::format("{} triangles use a vertex twice; they bound nothing", degenerate));
        if (document_.bent.count != 0)
            notes_.push_back(
                fmt::format("line {}: edges and normals bend triangles; they were passed over, as "
                            "all {} of them, and triangles are flat",
                            document_.bent.line, document_.bent.count));
        if (document_.supports.count != 0)
            notes_.push_back(fmt::format("line {}: {} volumes are supports; they were left out",
                                         document_.supports.line, document_.supports.count));
        if (not_printable_ != 0)
            notes_.push_back(fmt::format("{} instances are marked as not to be printed; they were left out",
                                         not_printable_));
        file_.instances = place_meshes(name_, nodes_, roots_, file_.objects, limits_, executor_);
        if (file_.objects.empty())
            fail("holds nothing to slice: no object with a triangle");
        if (file_.instances.empty())
            fail("holds nothing to slice: no instance leads to an object with a triangle");
    }

    std::string name_;
    Remarks remarks_;
    std::vector<std::string> notes_;
    ReadLimits limits_;
    const Execution& execution_;
    Executor executor_;
    ByteSource source_;
    AmfDocument document_;
    std::vector<AssemblyNode> nodes_; ///< objects, then constellations
    std::map<std::string, std::size_t> numbers_;
    std::vector<AssemblyUse> roots_;
    std::size_t not_printable_ = 0;
    MeshFile file_;
};

} // namespace

bool is_amf(std::string_view text) {
    return text.substr(0, longest_preface).find("<amf") != std::string_view::npos;
}

MeshFile read_amf(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    return AmfReader(source, options, execution).read();
}

} // namespace lamella
