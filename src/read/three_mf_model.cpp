// The 3MF Core Specification 1.x, chapter 3 and 4; the Production Extension 1.x for paths.

#include "read/three_mf_model.hpp"

#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "container/xml.hpp"
#include "read/decimal_text.hpp"
#include "read/plain_elements.hpp"
#include "read/read_limits.hpp"
#include "read/three_mf_properties.hpp"
#include "read/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace lamella {

namespace {

constexpr std::string_view xml_space = "http://www.w3.org/XML/1998/namespace";

/// Extensions without which a reader of meshes gets on, also where a file requires them.
constexpr std::array extensions = {
    three_mf::core,
    three_mf::production,
    three_mf::slices,
    three_mf::beams, // beams themselves are refused
    three_mf::materials,
    std::string_view("http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04"),
    std::string_view("http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07"),
};

constexpr std::array<std::pair<std::string_view, ThreeMfObjectType>, 5> types = {{
    {"model", ThreeMfObjectType::model},
    {"solidsupport", ThreeMfObjectType::solid_support},
    {"support", ThreeMfObjectType::support},
    {"surface", ThreeMfObjectType::surface},
    {"other", ThreeMfObjectType::other},
}};

constexpr std::uint32_t largest_id = 0x7FFFFFFF;
constexpr std::size_t longest_object_name = 200;
constexpr std::size_t longest_model_title = 1000;
constexpr std::size_t most_remarks = 50;

bool is_coordinate(double value) {
    return std::abs(value) <= farthest_coordinate;
}

class ModelReader {
  public:
    ModelReader(const ByteSource& source, std::string part, bool is_root, bool skim, ReadLimits& limits)
        : is_root_(is_root), skim_(skim), count_(limits) {
        model_.part = std::move(part);
        model_.source = source.name;
    }

    ThreeMfModel read(std::string_view document, const std::function<void(std::size_t)>& progress) {
        XmlHandlers handlers;
        handlers.start = [this](XmlName name, const XmlAttributes& attributes, std::size_t line) {
            line_ = line;
            if (where_.empty())
                is_beta_ = name.space == three_mf::beta_core;
            if (is_beta_ && name.space == three_mf::beta_core)
                name.space = three_mf::core;
            where_.push_back(start(name, attributes));
        };
        handlers.end = [this](XmlName) {
            end();
        };
        handlers.text = [this](std::string_view text) {
            if (!where_.empty() && where_.back() == Where::title && model_.title.size() < longest_model_title)
                model_.title += text;
        };
        handlers.declare = [this](std::string_view prefix, std::string_view space) {
            if (where_.empty())
                spaces_.emplace(prefix, space);
        };
        handlers.progress = progress;
        if (skim_) {
            handlers.many = {three_mf_text_form().vertex.tag, three_mf_text_form().triangle.tag};
            handlers.skim = [this](std::string_view text, std::size_t place) {
                return skim(text, place);
            };
        }
        parse_xml(document, model_.source, handlers,
                  {.namespaces = true, .utf8_only = true, .no_document_type = true});
        if (!has_resources_)
            fail("found no <resources>, expected one in <model>");
        if (is_root_ && !has_build_)
            fail("found no <build>, expected one in <model>");
        model_.title = printable(trimmed(model_.title), longest_model_title);
        for (const auto& [prefix, space] : spaces_)
            if (!prefix.empty())
                model_.prefixes.push_back(prefix);
        for (ThreeMfObject& object : model_.objects)
            object.text.prefixes = model_.prefixes; // moving the model leaves them where they are
        count_.keep(here());
        return std::move(model_);
    }

  private:
    enum class Where {
        model,
        title,
        resources,
        object,
        mesh,
        vertices,
        triangles,
        components,
        build,
        elsewhere ///< in something that is passed over
    };

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::input, fmt::format("{}, line {}: {}", model_.source, line_, what));
    }

    [[nodiscard]] std::string here() const {
        return fmt::format("part '{}', line {}", printable(model_.part, longest_object_name), line_);
    }

    void remark(const std::string& what, bool offence = true) {
        if (model_.remarks.size() < most_remarks)
            model_.remarks.push_back({fmt::format("{}: {}", here(), what), offence});
    }

    /// To be called before memory is taken.
    void count(std::uint64_t triangles, std::uint64_t bytes) {
        count_.add(triangles, bytes, [this] { return here(); });
    }

    Where start(XmlName name, const XmlAttributes& attributes) {
        if (where_.empty())
            return start_model(name, attributes);
        const Where in = where_.back();
        std::optional<std::uint32_t> id;
        if (in == Where::resources)
            id = take_id(name, attributes);
        if (in == Where::resources || in == Where::elsewhere)
            if (const auto wrong = properties_.check(name, attributes, id))
                remark(*wrong);
        if (in == Where::elsewhere || in == Where::title)
            return Where::elsewhere;
        if (name == XmlName{three_mf::beams, "beamlattice"} && in == Where::mesh) {
            if (required_.contains(std::string(three_mf::beams)))
                fail("found a beam lattice; those cannot be read, and the file requires it");
            remark("found a beam lattice; its beams were left out");
        }
        if (name.space != three_mf::core)
            return Where::elsewhere;
        const std::string_view element = name.local;
        switch (in) {
        case Where::model:
            if (element == "resources")
                return start_resources();
            if (element == "build")
                return start_build();
            if (element == "metadata")
                return start_metadata(attributes);
            break;
        case Where::resources:
            if (element == "object")
                return start_object(attributes);
            if (element == "basematerials")
                return Where::elsewhere;
            break;
        case Where::object:
            if (element == "mesh")
                return start_mesh();
            if (element == "components")
                return start_components();
            if (element == "metadatagroup")
                return Where::elsewhere;
            break;
        case Where::mesh:
            if (element == "vertices")
                return once(Where::vertices, has_vertices_, "<vertices>");
            if (element == "triangles")
                return once(Where::triangles, has_triangles_, "<triangles>");
            break;
        case Where::vertices:
            if (element == "vertex") {
                add_vertex(attributes);
                return Where::elsewhere;
            }
            break;
        case Where::triangles:
            if (element == "triangle") {
                add_triangle(attributes);
                return Where::elsewhere;
            }
            break;
        case Where::components:
            if (element == "component") {
                object().components.push_back(use(attributes));
                return Where::elsewhere;
            }
            break;
        case Where::build:
            if (element == "item") {
                model_.items.push_back(use(attributes));
                return Where::elsewhere;
            }
            break;
        default:
            break;
        }
        remark(fmt::format("found <{}>, which has no business here; it was passed over",
                           printable(element, 40)));
        return Where::elsewhere;
    }

    void end() {
        const Where ended = where_.back();
        where_.pop_back();
        if (ended == Where::object && !object().is_mesh && object().components.empty())
            fail(fmt::format("found object {} with neither a mesh nor components", object().id));
    }

    Where start_model(XmlName name, const XmlAttributes& attributes) {
        if (name != XmlName{three_mf::core, "model"})
            fail(fmt::format("found <{}> of namespace '{}', expected <model> of '{}'",
                             printable(name.local, 40), printable(name.space, 100), three_mf::core));
        if (is_beta_)
            remark(fmt::format("found a file of the beta of 3MF ('{}'); its meshes, components and build are "
                               "taken as today's",
                               three_mf::beta_core));
        if (const std::string_view unit = attributes.find("unit"); unit.data() != nullptr) {
            const std::optional<double> known = three_mf::unit_mm(unit);
            if (!known)
                fail(fmt::format("found unit '{}', expected micron, millimeter, centimeter, inch, foot or "
                                 "meter",
                                 printable(unit, 40)));
            model_.unit_mm = *known;
        }
        if (attributes.find(XmlName{xml_space, "space"}).data() != nullptr)
            remark("found xml:space, which 3MF files must not use");
        std::string_view prefixes = attributes.find("requiredextensions");
        while (!(prefixes = trimmed(prefixes)).empty()) {
            const std::string prefix(prefixes.substr(0, prefixes.find_first_of(" \t\r\n")));
            prefixes.remove_prefix(prefix.size());
            const auto space = spaces_.find(prefix);
            if (space == spaces_.end())
                fail(fmt::format("the file requires the extension '{}' without saying what that is",
                                 printable(prefix, 40)));
            if (std::find(extensions.begin(), extensions.end(), space->second) == extensions.end())
                fail(fmt::format("the file requires the extension '{}' ({}), which is not known here",
                                 printable(prefix, 40), printable(space->second, 200)));
            required_.insert(space->second);
        }
        return Where::model;
    }

    Where start_resources() {
        if (std::exchange(has_resources_, true))
            fail("found a second <resources>, expected one");
        return Where::resources;
    }

    Where start_build() {
        if (std::exchange(has_build_, true))
            fail("found a second <build>, expected one");
        return is_root_ ? Where::build : Where::elsewhere; // that of other parts does not count
    }

    Where start_metadata(const XmlAttributes& attributes) {
        const std::string_view name = attributes.find("name");
        count(0, node_bytes + name.size());
        if (name.data() == nullptr)
            remark("found metadata without a name");
        else if (!metadata_.emplace(name).second)
            remark(fmt::format("found metadata '{}' for the second time", printable(name, 40)));
        return name == "Title" && model_.title.empty() ? Where::title : Where::elsewhere;
    }

    /// All resources share one set of ids.
    std::optional<std::uint32_t> take_id(XmlName name, const XmlAttributes& attributes) {
        const bool is_object = name == XmlName{three_mf::core, "object"};
        const std::string_view text = attributes.find("id");
        if (text.data() == nullptr && !is_object)
            return std::nullopt;
        const std::uint32_t id = number(attributes, "id");
        if (id == 0 || id > largest_id)
            fail(fmt::format("found id {}, expected 1 to {}", id, largest_id));
        count(0, node_bytes + (is_object ? sizeof(ThreeMfObject) : 0));
        const auto [other, is_new] = ids_.emplace(id, is_object);
        if (is_new)
            return id;
        const std::string what = fmt::format("found id {} for the second time", id);
        if (is_object || other->second)
            fail(what);
        remark(what);
        return std::nullopt;
    }

    Where start_object(const XmlAttributes& attributes) {
        ThreeMfObject object;
        object.id = number(attributes, "id");
        object.line = line_;
        object.name = printable(trimmed(attributes.find("name")), longest_object_name);
        if (const std::string_view type = attributes.find("type"); type.data() != nullptr) {
            const auto* const known =
                std::find_if(types.begin(), types.end(), [&](const auto& row) { return row.first == type; });
            if (known == types.end())
                fail(fmt::format(
                    "found an object of type '{}', expected model, solidsupport, support, surface "
                    "or other",
                    printable(type, 40)));
            object.type = known->second;
        }
        if (attributes.find("pindex").data() != nullptr && attributes.find("pid").data() == nullptr)
            remark("found pindex without pid");
        if (attributes.find(XmlName{three_mf::slices, "meshresolution"}) == "lowres")
            remark(fmt::format("object {} is meant to be taken from its slices; its mesh is only a coarse "
                               "stand-in",
                               object.id));
        model_.objects.push_back(std::move(object));
        has_vertices_ = has_triangles_ = false;
        return Where::object;
    }

    Where start_mesh() {
        if (object().is_mesh || !object().components.empty())
            fail(fmt::format(
                "found a second content of object {}, expected one mesh or one list of components",
                object().id));
        object().is_mesh = true;
        return Where::mesh;
    }

    Where start_components() {
        if (object().is_mesh || !object().components.empty())
            fail(fmt::format(
                "found a second content of object {}, expected one mesh or one list of components",
                object().id));
        return Where::components;
    }

    Where once(Where next, bool& seen, std::string_view what) {
        if (std::exchange(seen, true))
            fail(fmt::format("found a second {} in the mesh of object {}, expected one", what, object().id));
        return next;
    }

    /// Leaves a run of vertices or triangles to others.
    std::size_t skim(std::string_view document, std::size_t place) {
        const Where in = where_.empty() ? Where::elsewhere : where_.back();
        if (in != Where::vertices && in != Where::triangles)
            return 0;
        MeshText& text = object().text;
        text.place = here();
        return in == Where::vertices ? take_run(document, place, "</vertices", text.vertices)
                                     : take_run(document, place, "</triangles", text.triangles);
    }

    void add_vertex(const XmlAttributes& attributes) {
        require_all_by_parser();
        count(0, sizeof(Point3));
        object().mesh.vertices.push_back(
            {coordinate(attributes, "x"), coordinate(attributes, "y"), coordinate(attributes, "z")});
    }

    void add_triangle(const XmlAttributes& attributes) {
        require_all_by_parser();
        count(1, sizeof(TriangleIndices));
        IndexedMesh& mesh = object().mesh;
        TriangleIndices corners;
        constexpr std::array<std::string_view, 3> names = {"v1", "v2", "v3"};
        for (std::size_t k = 0; k < 3; ++k) {
            corners[k] = number(attributes, names[k]);
            if (corners[k] >= mesh.vertices.size())
                fail(fmt::format("found {} = {}, expected less than {}, the number of vertices", names[k],
                                 corners[k], mesh.vertices.size()));
        }
        mesh.triangles.push_back(corners);
    }

    /// Where runs are skimmed no vertex may come past the parser: their order would be lost.
    void require_all_by_parser() const {
        if (skim_)
            fail("found a mesh that is not written plainly");
    }

    ThreeMfUse use(const XmlAttributes& attributes) {
        count(0, sizeof(ThreeMfUse));
        ThreeMfUse use;
        use.line = line_;
        use.object = number(attributes, "objectid");
        use.printable = trimmed(attributes.find("printable")) != "0";
        if (const std::string_view path = attributes.find(XmlName{three_mf::production, "path"});
            path.data() != nullptr) {
            if (!is_root_)
                fail(fmt::format("found path '{}' in a part that is not the root; only the root may refer to "
                                 "other parts",
                                 printable(path, 100)));
            use.part = path;
        }
        if (const std::string_view numbers = attributes.find("transform"); numbers.data() != nullptr)
            use.placement = transform(numbers);
        return use;
    }

    /// Twelve numbers, row by row of a matrix that rows are multiplied with from the left.
    [[nodiscard]] Transform transform(std::string_view text) const {
        std::array<double, 12> m{};
        std::string_view rest = trimmed(text);
        for (double& number : m) {
            const char* const stop = read_decimal(rest.data(), rest.data() + rest.size(), number);
            if (stop == nullptr || !is_coordinate(number) ||
                (stop != rest.data() + rest.size() && trimmed({stop, 1}).size() == 1))
                fail(fmt::format("found transform '{}', expected 12 numbers with blanks between them",
                                 printable(text, 200)));
            rest = trimmed(rest.substr(static_cast<std::size_t>(stop - rest.data())));
        }
        if (!rest.empty())
            fail(fmt::format("found transform '{}', expected 12 numbers and no more", printable(text, 200)));
        Transform map;
        for (std::size_t to = 0; to < 3; ++to) {
            for (std::size_t from = 0; from < 3; ++from)
                map.linear[to][from] = m[3 * from + to];
            map.offset[to] = m[9 + to] * model_.unit_mm;
        }
        if (!(std::abs(map.determinant()) > 0))
            fail(fmt::format("found transform '{}', which flattens what it is applied to",
                             printable(text, 200)));
        return map;
    }

    [[nodiscard]] double coordinate(const XmlAttributes& attributes, std::string_view name) const {
        const std::string_view text = trimmed(value(attributes, name));
        double number = 0;
        if (read_decimal(text.data(), text.data() + text.size(), number) != text.data() + text.size() ||
            text.empty() || !is_coordinate(number))
            fail(fmt::format("found {} = '{}', expected a number within {}", name, printable(text, 40),
                             farthest_coordinate));
        return number;
    }

    [[nodiscard]] std::uint32_t number(const XmlAttributes& attributes, std::string_view name) const {
        const std::string_view text = trimmed(value(attributes, name));
        std::uint32_t number = 0;
        if (read_index(text.data(), text.data() + text.size(), number) != text.data() + text.size() ||
            text.empty())
            fail(fmt::format("found {} = '{}', expected a whole number", name, printable(text, 40)));
        return number;
    }

    [[nodiscard]] std::string_view value(const XmlAttributes& attributes, std::string_view name) const {
        const std::string_view text = attributes.find(name);
        if (text.data() == nullptr)
            fail(fmt::format("found an element without {}, expected a number there", name));
        return text;
    }

    [[nodiscard]] ThreeMfObject& object() { return model_.objects.back(); }

    ThreeMfModel model_;
    bool is_root_;
    bool skim_;
    bool is_beta_ = false;
    GrowingMeshCount count_;
    std::size_t line_ = 1;
    std::vector<Where> where_;
    std::map<std::string, std::string> spaces_; ///< prefixes that the root element declares
    std::set<std::string> required_;
    std::set<std::string> metadata_;
    std::map<std::uint32_t, bool> ids_; ///< and whether an object has it
    ThreeMfProperties properties_;
    bool has_resources_ = false;
    bool has_build_ = false;
    bool has_vertices_ = false;
    bool has_triangles_ = false;
};

bool read_model_vertices(std::string_view run, const MeshText& text, std::span<Point3> vertices) {
    PlainElements elements(run, text.prefixes);
    for (Point3& vertex : vertices) {
        std::array<double, 3> numbers{};
        const auto read = [&](const char* name, std::size_t length, const char* value) -> PlainValue {
            if (length != 1 || *name < 'x' || *name > 'z')
                return {};
            const int axis = *name - 'x';
            const char* const end = read_decimal(value, elements.end(), numbers[axis]);
            return {axis, is_coordinate(numbers[axis]) ? end : nullptr};
        };
        if (!elements.take("<vertex", 3, read))
            return false;
        vertex = {numbers[0], numbers[1], numbers[2]};
    }
    return elements.done();
}

bool read_model_triangles(std::string_view run, const MeshText& text, std::span<TriangleIndices> triangles) {
    PlainElements elements(run, text.prefixes);
    for (TriangleIndices& corners : triangles) {
        const auto read = [&](const char* name, std::size_t length, const char* value) -> PlainValue {
            if (length != 2 || name[0] != 'v' || name[1] < '1' || name[1] > '3')
                return {};
            const int corner = name[1] - '1';
            return {corner, read_index(value, elements.end(), corners[corner])};
        };
        if (!elements.take("<triangle", 3, read))
            return false;
    }
    return elements.done();
}

} // namespace

ThreeMfModel read_three_mf_model(const ByteSource& source, std::string part, bool is_root, bool skim,
                                 ReadLimits& limits, const std::function<void(std::size_t)>& progress) {
    const std::string_view document = source.text();
    return ModelReader(source, std::move(part), is_root, skim, limits).read(document, progress);
}

const MeshTextForm& three_mf_text_form() noexcept {
    static const MeshTextForm form{
        {"<vertex", 1, std::string_view("<vertex x=\"0\" y=\"0\" z=\"0\"/>").size(), read_model_vertices},
        {"<triangle", 1, std::string_view("<triangle v1=\"0\" v2=\"1\" v3=\"2\"/>").size(),
         read_model_triangles}};
    return form;
}

} // namespace lamella
