// The 3MF Core Specification 1.x, chapter 3 and 4; the Production Extension 1.x for paths.

#include "meshes/three_mf_model.hpp"

#include "container/plain_values.hpp"
#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "container/xml.hpp"
#include "core/lower_case.hpp"
#include "meshes/mesh_document.hpp"
#include "meshes/three_mf_part.hpp"
#include "meshes/three_mf_properties.hpp"
#include "meshes/three_mf_terms.hpp"

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

constexpr std::uint32_t largest_id = 0x7FFFFFFF;
constexpr std::size_t longest_object_name = 200;
constexpr std::size_t longest_model_title = 1000;
constexpr std::size_t most_remarks = 50;
constexpr std::size_t longest_setting = 100; ///< of settings that are read
constexpr std::string_view full_resolution = "fullres";

/// Returns the object for an <object> element, without its contents.
ThreeMfObject object_of(const ThreeMfElement& element) {
    ThreeMfObject object;
    object.id = element["id"].index();
    object.line = element.line;
    object.name = printable(element["name"].text, longest_object_name);
    object.type = element.object_type();
    object.role = role_of(object.type);
    object.is_coarse = element[XmlName{three_mf::slices, "meshresolution"}].text == "lowres";
    const std::string_view resolution = element[XmlName{three_mf::alternatives, "modelresolution"}].text;
    if (!resolution.empty() && resolution != full_resolution)
        object.substitute = printable(resolution, longest_setting);
    return object;
}

/// Settings of Cura that give a body its role if they are true.
constexpr std::array<std::pair<std::string_view, MeshRole>, 4> cura_roles = {{
    {"anti_overhang_mesh", MeshRole::support_blocker},
    {"support_mesh", MeshRole::support},
    {"infill_mesh", MeshRole::modifier},
    {"cutting_mesh", MeshRole::modifier},
}};

/// Returns "support_mesh" of "cura:support_mesh".
std::string_view local_name(std::string_view name) {
    return name.substr(name.find(':') + 1);
}

bool says_true(std::string_view text) {
    const std::string word = lower_case(text);
    return word == "true" || word == "1";
}

constexpr std::array<std::string_view, 3> vertex_values = {"x", "y", "z"};
constexpr std::array<std::string_view, 3> triangle_values = {"v1", "v2", "v3"};

TriangleIndices triangle_of(const ThreeMfElement& element, std::size_t vertices) {
    TriangleIndices corners{};
    for (std::size_t k = 0; k < 3; ++k) {
        corners[k] = element[triangle_values[k]].index();
        if (corners[k] >= vertices)
            element.fail(fmt::format("{} = {}", triangle_values[k], corners[k]),
                         fmt::format("less than {}, the number of vertices", vertices));
    }
    return corners;
}

/// The ids of a part; all its resources share one set of them.
class ResourceIds {
  public:
    /// Takes the id of a resource, or none if it has no id. `remark` is called for each violation.
    template <class Remark>
    std::optional<std::uint32_t> take(const ThreeMfElement& element, std::uint32_t smallest_id,
                                      const Remark& remark) {
        const bool is_object = element.name == XmlName{three_mf::core, "object"};
        const ThreeMfValue value = element["id"];
        if (!value.is_there && !is_object)
            return std::nullopt;
        const std::uint32_t id = value.index();
        if (id < smallest_id || id > largest_id)
            element.fail(fmt::format("id {}", id), fmt::format("{} to {}", smallest_id, largest_id));
        const auto [other, is_new] = ids_.emplace(id, is_object);
        if (is_new)
            return id;
        const std::string found = fmt::format("id {} for the second time", id);
        if (is_object || other->second)
            element.fail(found, "ids that differ");
        remark("found " + found);
        return std::nullopt;
    }

  private:
    std::map<std::uint32_t, bool> ids_; ///< true if an object has the id
};

/// Element that contains the current one.
enum class ModelElement {
    outside,
    model,
    title,
    resources,
    object,
    settings, ///< of an object
    setting,
    slic3r_volumes, ///< of a mesh
    alternatives,   ///< of an object
    mesh,
    vertices,
    triangles,
    components,
    build,
    elsewhere ///< in an element that is skipped
};

class ModelReader final : MeshDocumentReader<ThreeMfModel, ModelElement> {
  public:
    ModelReader(const ByteSource& source, const std::string& part, bool is_root, Executor& executor,
                ReadLimits& limits)
        : MeshDocumentReader(source.name, fmt::format("part '{}', ", printable(part, longest_object_name)),
                             executor, limits),
          is_root_(is_root) {
        document().part = part;
        document().source = source.name;
    }

    ThreeMfModel read(std::string_view text, const std::function<void(std::size_t)>& progress) {
        ThreeMfModel& model = document();
        XmlHandlers handlers;
        handlers.text = [&](std::string_view chunk) {
            if (in() == Where::title && model.title.size() < longest_model_title)
                model.title += chunk;
            else if (in() == Where::setting && setting_value_.size() < longest_setting)
                setting_value_ += chunk;
        };
        handlers.declare = [this](std::string_view prefix, std::string_view space) {
            spaces_.emplace(prefix, space);
        };
        handlers.progress = progress;
        parse(text, three_mf_text_form(), std::move(handlers), three_mf_rules);
        if (!seen_.contains(Where::resources))
            fail("found no <resources>, expected one in <model>");
        if (is_root_ && !seen_.contains(Where::build))
            fail("found no <build>, expected one in <model>");
        model.title = printable(trimmed(model.title), longest_model_title);
        return take();
    }

  private:
    using Where = ModelElement;
    using Step = Where (ModelReader::*)(const ThreeMfElement&);

    static const auto& rules() {
        using Self = ModelReader;
        static constexpr auto all = std::to_array<ElementRule<Where, Step>>(
            {{Where::vertices, "vertex", &Self::add_vertex},
             {Where::triangles, "triangle", &Self::add_triangle},
             {Where::model, "resources", &Self::once<Where::resources>},
             {Where::model, "build", &Self::start_build},
             {Where::model, "metadata", &Self::start_metadata},
             {Where::resources, "object", &Self::start_object},
             {Where::resources, "basematerials", &Self::pass_over},
             {Where::object, "mesh", &Self::start_mesh},
             {Where::object, "components", &Self::start_components},
             {Where::object, "metadatagroup", &Self::is<Where::settings>},
             {Where::settings, "metadata", &Self::start_setting},
             {Where::mesh, "vertices", &Self::once<Where::vertices>},
             {Where::mesh, "triangles", &Self::start_triangles},
             {Where::components, "component", &Self::add_component},
             {Where::build, "item", &Self::add_item}});
        return all;
    }

    Where start(XmlName name, const XmlAttributes& attributes) override {
        if (in() == Where::outside)
            is_beta_ = name.space == three_mf::beta_core;
        if (is_beta_ && name.space == three_mf::beta_core)
            name.space = three_mf::core;
        return start({document().source, name, attributes, line(), spaces_});
    }

    Where start(const ThreeMfElement& element) {
        if (in() == Where::outside)
            return start_model(element);
        std::optional<std::uint32_t> id;
        if (in() == Where::resources) {
            count(node_bytes);
            id = ids_.take(element, is_beta_ ? 0 : 1, [this](const std::string& what) { remark(what); });
        }
        if (in() == Where::resources || in() == Where::elsewhere)
            if (const auto wrong = properties_.check(element.name, element.attributes, id))
                remark(*wrong);
        if (in() == Where::elsewhere || in() == Where::title || in() == Where::setting)
            return Where::elsewhere;
        if (element.name == XmlName{three_mf::beams, "beamlattice"} && in() == Where::mesh) {
            if (required_.contains(std::string(three_mf::beams)))
                fail("found a beam lattice; those cannot be read, and the file requires it");
            remark("found a beam lattice; its beams were left out");
        }
        if (element.name.space != three_mf::core)
            return start_foreign(element);
        if (const Step step = step_for(rules(), in(), element.name.local))
            return (this->*step)(element);
        remark(fmt::format("found <{}>, which has no business here; it was passed over",
                           printable(element.name.local, 40)));
        return Where::elsewhere;
    }

    /// Handles elements that are not part of the format but written by certain programs.
    Where start_foreign(const ThreeMfElement& element) {
        const std::string_view space = element.name.space;
        const std::string_view name = element.name.local;
        if (space == three_mf::cura && in() == Where::object && name == "settings")
            return Where::settings;
        if (space == three_mf::alternatives && in() == Where::object && name == "alternatives")
            return Where::alternatives;
        if (space == three_mf::alternatives && in() == Where::alternatives && name == "alternative")
            add_alternative(element);
        if (in() == Where::object && object().foreign.empty())
            object().foreign =
                fmt::format("<{}> of '{}'", printable(name, 40), printable(space, longest_object_name));
        if (space == three_mf::cura && in() == Where::settings && name == "setting")
            return start_setting(element);
        if (space.starts_with(three_mf::slic3r) && in() == Where::mesh && name == "volumes")
            return Where::slic3r_volumes;
        if (space.starts_with(three_mf::slic3r) && in() == Where::slic3r_volumes && name == "volume")
            add_volume(element);
        return Where::elsewhere;
    }

    template <ModelElement what>
    Where is(const ThreeMfElement&) {
        return what;
    }

    /// Keeps the alternative in full resolution. Its attributes may have the prefix of their extension.
    void add_alternative(const ThreeMfElement& element) {
        const auto attribute = [&](std::string_view name) {
            const ThreeMfValue qualified = element[XmlName{three_mf::alternatives, name}];
            return qualified.is_there ? qualified : element[name];
        };
        const ThreeMfValue resolution = attribute("modelresolution");
        if (full_alternative_ || (resolution.is_there && resolution.text != full_resolution))
            return;
        full_alternative_ = ThreeMfUse{.object = attribute("objectid").index(),
                                       .part = std::string(attribute("path").text),
                                       .placement = {},
                                       .printable = true,
                                       .line = element.line};
        require_root_of_paths(element, *full_alternative_);
    }

    /// Replaces the contents of an object that is only a substitute by its alternative, if the file names it.
    void end_object() {
        if (!object().is_mesh && object().components.empty())
            fail(fmt::format("found object {} with neither a mesh nor components{}", object().id,
                             object().foreign.empty()
                                 ? ""
                                 : fmt::format(" but with {}, an extension that is not read; save the file "
                                               "with triangles alone",
                                               object().foreign)));
        std::optional<ThreeMfUse> full = std::exchange(full_alternative_, std::nullopt);
        if (object().substitute.empty() || !full)
            return;
        object().is_substituted = true;
        object().is_mesh = false;
        drop_mesh();
        object().volumes.clear();
        object().components.clear();
        append(object().components, *std::move(full));
    }

    Where start_setting(const ThreeMfElement& element) {
        setting_ = local_name(element["name"].is_there ? element["name"].text : element["key"].text);
        setting_value_.clear();
        return Where::setting;
    }

    void add_volume(const ThreeMfElement& element) {
        const std::uint64_t begin = element["ts"].index();
        append(object().volumes,
               VolumeRange{begin, std::max<std::uint64_t>(begin, element["te"].index() + std::uint64_t{1}),
                           element["modifier"].text == "1" ? MeshRole::modifier : MeshRole::part});
    }

    void end(Where ended) override {
        if (ended == Where::setting && says_true(trimmed(setting_value_)))
            for (const auto& [name, role] : cura_roles)
                if (name == setting_)
                    object().role = role;
        if (ended == Where::object)
            end_object();
    }

    void remark(const std::string& what) {
        if (document().remarks.size() < most_remarks)
            document().remarks.push_back(fmt::format("{}: {}", here(), what));
    }

    Where start_model(const ThreeMfElement& element) {
        if (element.name != XmlName{three_mf::core, "model"})
            element.fail(fmt::format("<{}> of namespace '{}'", printable(element.name.local, 40),
                                     printable(element.name.space, 100)),
                         fmt::format("<model> of '{}'", three_mf::core));
        if (is_beta_)
            remark(fmt::format("found a file of the beta of 3MF ('{}'); its meshes, components and build are "
                               "taken as today's",
                               three_mf::beta_core));
        document().unit_mm = element.unit_mm();
        if (element[XmlName{xml_space, "space"}].is_there)
            remark("found xml:space, which 3MF files must not use");
        required_ = element.required_extensions();
        return Where::model;
    }

    Where pass_over(const ThreeMfElement&) { return Where::elsewhere; }

    /// Refuses an element that must not occur twice.
    template <ModelElement what>
    Where once(const ThreeMfElement& element) {
        if (!seen_.insert(what).second)
            element.fail(fmt::format("a second <{}>", element.name.local), "one");
        return what;
    }

    Where start_build(const ThreeMfElement& element) {
        const Where build = once<Where::build>(element);
        return is_root_ ? build : Where::elsewhere; // only the build of the root part counts
    }

    Where start_metadata(const ThreeMfElement& element) {
        const std::string_view name = element.attributes.find("name");
        count(node_bytes + name.size());
        if (name.data() == nullptr)
            remark("found metadata without a name");
        else if (!metadata_.emplace(name).second)
            remark(fmt::format("found metadata '{}' for the second time", printable(name, 40)));
        return name == "Title" && document().title.empty() ? Where::title : Where::elsewhere;
    }

    Where start_object(const ThreeMfElement& element) {
        append(document().objects, object_of(element));
        if (element["pindex"].is_there && !element["pid"].is_there)
            remark("found pindex without pid");
        seen_.erase(Where::vertices);
        seen_.erase(Where::triangles);
        return Where::object;
    }

    Where start_mesh(const ThreeMfElement& element) {
        require_no_content(element);
        object().is_mesh = true;
        return Where::mesh;
    }

    Where start_triangles(const ThreeMfElement& element) {
        if (!seen_.contains(Where::vertices))
            element.fail("<triangles> before <vertices>", "vertices first");
        return once<Where::triangles>(element);
    }

    Where start_components(const ThreeMfElement& element) {
        require_no_content(element);
        return Where::components;
    }

    void require_no_content(const ThreeMfElement& element) {
        if (object().is_mesh || !object().components.empty())
            element.fail(fmt::format("a second content of object {}", object().id),
                         "one mesh or one list of components");
    }

    Where add_vertex(const ThreeMfElement& element) {
        std::array<double, 3> xyz{};
        static_cast<void>(element.take(vertex_values, xyz));
        add(Point3{xyz[0], xyz[1], xyz[2]});
        return Where::elsewhere;
    }

    Where add_triangle(const ThreeMfElement& element) {
        add(triangle_of(element, object().mesh.vertices.size()));
        return Where::elsewhere;
    }

    [[nodiscard]] ThreeMfUse use_of(const ThreeMfElement& element) {
        ThreeMfUse use = element.use(document().unit_mm);
        require_root_of_paths(element, use);
        return use;
    }

    void require_root_of_paths(const ThreeMfElement& element, const ThreeMfUse& use) const {
        if (!is_root_ && !use.part.empty())
            element.fail(fmt::format("path '{}' in a part that is not the root", printable(use.part, 100)),
                         "none: only the root may refer to other parts");
    }

    Where add_component(const ThreeMfElement& element) {
        append(object().components, use_of(element));
        return Where::elsewhere;
    }

    Where add_item(const ThreeMfElement& element) {
        append(document().items, use_of(element));
        return Where::elsewhere;
    }

    bool is_root_;
    bool is_beta_ = false;
    std::string setting_; ///< name of the current setting
    std::string setting_value_;
    std::optional<ThreeMfUse> full_alternative_; ///< of the current object
    std::set<Where> seen_; ///< elements that must not occur twice; vertices and triangles of this object
    ThreeMfSpaces spaces_;
    std::set<std::string> required_;
    std::set<std::string> metadata_;
    ResourceIds ids_;
    ThreeMfProperties properties_;
};

std::size_t read_model_vertices(XmlCursor& cursor, std::size_t, std::span<Point3> vertices) {
    return take_items(cursor, vertices, [&](Point3& vertex) {
        std::array<double, 3> numbers{};
        if (!cursor.take("<vertex") || take_values(cursor, vertex_values, numbers) != XmlTagEnd::element)
            return false;
        vertex = {numbers[0], numbers[1], numbers[2]};
        return true;
    });
}

std::size_t read_model_triangles(XmlCursor& cursor, std::size_t vertices,
                                 std::span<TriangleIndices> triangles) {
    return take_items(cursor, triangles, [&](TriangleIndices& t) {
        return cursor.take("<triangle") && take_values(cursor, triangle_values, t) == XmlTagEnd::element &&
               std::max({t[0], t[1], t[2]}) < vertices;
    });
}

} // namespace

MeshRole role_of(ThreeMfObjectType type) noexcept {
    switch (type) {
    case ThreeMfObjectType::support:
        return MeshRole::support;
    case ThreeMfObjectType::surface:
        return MeshRole::surface;
    case ThreeMfObjectType::other:
        return MeshRole::other;
    case ThreeMfObjectType::model:
    case ThreeMfObjectType::solid_support:
        break;
    }
    return MeshRole::part;
}

ThreeMfModel read_three_mf_model(const ByteSource& source, const std::string& part, bool is_root,
                                 Executor& executor, ReadLimits& limits,
                                 const std::function<void(std::size_t)>& progress) {
    return ModelReader(source, part, is_root, executor, limits).read(source.text(), progress);
}

const MeshTextForm& three_mf_text_form() noexcept {
    static const MeshTextForm form{{"<vertex", "</vertices", read_model_vertices},
                                   {"<triangle", "</triangles", read_model_triangles}};
    return form;
}

} // namespace lamella
