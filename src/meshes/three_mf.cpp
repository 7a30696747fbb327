#include "lamella/core/error.hpp"

#include "container/opc_package.hpp"
#include "container/read_limits.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "meshes/assembly.hpp"
#include "meshes/body_selection.hpp"
#include "meshes/mesh_readers.hpp"
#include "meshes/mesh_text.hpp"
#include "meshes/remarks.hpp"
#include "meshes/role_gaps.hpp"
#include "meshes/slicer_config.hpp"
#include "meshes/three_mf_model.hpp"
#include "meshes/three_mf_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

namespace lamella {

namespace {

constexpr std::string_view ticket_type = "http://schemas.microsoft.com/3dmanufacturing/2013/01/printticket";
constexpr std::size_t longest_file_name = 200;

[[noreturn]] void refuse_package(const ZipReader& package, const std::string& what) {
    throw Error(ErrorKind::input, fmt::format("{}: {}", package.name(), what));
}

/// Thrown by a reader that must not read meshes of a package with slices.
struct MayHaveSlices {};

/// Loads the model parts of a package with their meshes: the root and all parts that it refers to.
class PartLoader {
  public:
    /// With `no_slices`, load() throws MayHaveSlices if a part mentions the namespace of slices.
    PartLoader(const ZipReader& package, bool no_slices, Remarks& remarks, ReadLimits& limits,
               Executor& executor, const Execution& execution)
        : package_(package), no_slices_(no_slices), remarks_(remarks), limits_(limits), executor_(executor),
          progress_(execution, Stage::read, bytes_of(package)) {}

    void load() {
        if (package_.find("[Content_Types].xml") == nullptr)
            remarks_.add("found no [Content_Types].xml in the package");
        load_parts(find_root());
        progress_.finish();
    }

    /// The parts of the package, the root first.
    [[nodiscard]] std::vector<ThreeMfModel>& parts() noexcept { return parts_; }
    /// Returns the number of the part that contains a used object.
    [[nodiscard]] std::size_t part_of(const ThreeMfUse& use, std::size_t user) const {
        return use.part.empty() ? user : part_index_.at(use.part);
    }

  private:
    /// Returns the size of all entries, because it is not yet known which ones are needed.
    static std::uint64_t bytes_of(const ZipReader& zip) {
        std::uint64_t bytes = 0;
        for (const ZipEntry& entry : zip.entries())
            bytes += entry.size;
        return bytes;
    }

    std::string find_root() {
        std::vector<std::string> targets;
        for (const OpcRelationship& relationship : relationships_of("")) {
            if (relationship.type != three_mf::model_type)
                continue;
            if (relationship.external)
                refuse_package(package_, "the model lies outside of the package, expected a part of it");
            if (std::find(targets.begin(), targets.end(), relationship.target) == targets.end())
                targets.push_back(relationship.target);
        }
        if (targets.size() > 1)
            refuse_package(package_, fmt::format("the package names {} models ('{}', '{}'), expected one",
                                                 targets.size(), printable(targets[0], longest_file_name),
                                                 printable(targets[1], longest_file_name)));
        if (!targets.empty()) {
            if (package_.find(targets.front()) == nullptr)
                refuse_package(package_, fmt::format("the package names the model '{}', which is not in it",
                                                     printable(targets.front(), longest_file_name)));
            return targets.front();
        }
        const ZipEntry* entry = package_.find(three_mf::usual_root);
        for (const ZipEntry& other : package_.entries())
            if (entry == nullptr && other.name.ends_with(".model"))
                entry = &other;
        if (entry == nullptr)
            refuse_package(
                package_,
                "is a zip archive without a model, expected a 3MF file; unpack it and slice what is in it");
        remarks_.add(fmt::format("the package does not say which part is its model; took '{}'",
                                 printable(entry->name, longest_file_name)));
        return entry->name;
    }

    /// Returns the relationships of a part. Adds remarks about their defects.
    std::vector<OpcRelationship> relationships_of(const std::string& part) {
        std::vector<OpcRelationship> found = opc_relationships(package_, part);
        std::size_t tickets = 0;
        std::size_t astray = 0;
        const OpcRelationship* first_astray = nullptr;
        for (const OpcRelationship& relationship : found) {
            tickets += relationship.type == ticket_type ? 1 : 0;
            if (!relationship.external && relationship.type != three_mf::model_type &&
                package_.find(relationship.target) == nullptr && astray++ == 0)
                first_astray = &relationship;
        }
        if (first_astray != nullptr)
            remarks_.add(fmt::format("{} references of the package lead to no part of it (the first is '{}')",
                                     astray, printable(first_astray->target, longest_file_name)));
        if (tickets > 1)
            remarks_.add(fmt::format("the package has {} print tickets for one part, expected one", tickets));
        return found;
    }

    /// Loads the root part and all parts that it refers to.
    void load_parts(const std::string& root) {
        parts_.emplace_back().part = root;
        part_index_.emplace(root, 0);
        load_parts_from(0);
        ThreeMfModel& model = parts_[0];
        std::vector<ThreeMfUse*> uses;
        for (ThreeMfUse& item : model.items)
            uses.push_back(&item);
        for (ThreeMfObject& object : model.objects)
            for (ThreeMfUse& component : object.components)
                uses.push_back(&component);
        std::vector<std::string> others;
        for (ThreeMfUse* use : uses)
            if (!use->part.empty())
                find_part(*use, others);
        std::set<std::string> listed;
        for (OpcRelationship& relationship : relationships_of(root))
            listed.insert(std::move(relationship.target));
        for (const std::string& part : others) {
            if (!listed.contains(part))
                remarks_.add(fmt::format("the part '{}' is used without a relationship to it",
                                         printable(part, longest_file_name)));
            parts_.emplace_back().part = part;
        }
        if (!others.empty())
            load_parts_from(1);
    }

    /// Adds the part that contains a used object to `others`, under its name in the archive.
    void find_part(ThreeMfUse& use, std::vector<std::string>& others) {
        const ThreeMfModel& root = parts_[0];
        use.part = opc_resolved(package_, root.part, use.part);
        if (!part_index_.emplace(use.part, 1 + others.size()).second)
            return;
        if (package_.find(use.part) == nullptr)
            throw Error(ErrorKind::input,
                        fmt::format("{}, line {}: refers to the part '{}', which is not in the package",
                                    root.source, use.line, printable(use.part, longest_file_name)));
        others.push_back(use.part);
    }

    /// Decompresses and reads parts in parallel. All threads read a single part.
    void load_parts_from(std::size_t first) {
        const bool single = parts_.size() - first == 1;
        executor_.for_chunks(parts_.size() - first, 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            ThreeMfModel& part = parts_[first + i];
            Executor alone({.threads = 1});
            Executor& of_part = single ? executor_ : alone;
            const ByteSource bytes = unpacked_entry(package_, *package_.find(part.part), limits_, &of_part);
            if (no_slices_ && bytes.text().find(three_mf::slices) != std::string_view::npos)
                throw MayHaveSlices();
            part = read_three_mf_model(bytes, part.part, first + i == 0, of_part, limits_,
                                       [&](std::size_t read) {
                                           executor_.check_cancelled();
                                           progress_.add(read);
                                       });
        });
    }

    const ZipReader& package_;
    bool no_slices_;
    Remarks& remarks_;
    ReadLimits& limits_;
    Executor& executor_;
    ProgressMeter progress_;
    std::vector<ThreeMfModel> parts_;
    std::map<std::string, std::size_t> part_index_;
};

class ThreeMfReader {
  public:
    ThreeMfReader(const ByteSource& source, bool no_slices, const MeshReadOptions& options,
                  const Execution& execution)
        : package_(source, most_unpacked(options)), remarks_(source.name, options.strict),
          selection_(options.include), limits_(source, options), executor_(execution),
          loader_(package_, no_slices, remarks_, limits_, executor_, execution) {}

    MeshFile read() {
        for (const std::string& warning : package_.counted_warnings())
            remarks_.add(warning);
        loader_.load();
        for (const ThreeMfModel& part : parts_)
            for (const std::string& remark : part.remarks)
                remarks_.add(remark);
        config_ = read_slicer_config(package_, remarks_, limits_, executor_);
        make_nodes();
        make_file();
        const ThreeMfModel& model = parts_.front();
        file_.unit_mm = model.unit_mm;
        file_.name = !model.title.empty() ? model.title : file_.objects.front().name;
        file_.warnings = remarks_.take();
        return std::move(file_);
    }

  private:
    /// Makes one node for each object of each part.
    void make_nodes() {
        std::size_t objects = 0;
        std::size_t uses = parts_[0].items.size();
        for (const ThreeMfModel& part : parts_) {
            objects += part.objects.size();
            for (const ThreeMfObject& object : part.objects)
                uses += object.components.size();
        }
        count_assembly(objects, uses, limits_);
        std::vector<std::map<std::uint32_t, std::size_t>> numbers(parts_.size());
        for (std::size_t i = 0; i < parts_.size(); ++i)
            for (std::size_t k = 0; k < parts_[i].objects.size(); ++k) {
                numbers[i].emplace(parts_[i].objects[k].id, nodes_.size());
                sources_.push_back(&parts_[i].objects[k]);
                const double unit = parts_[i].unit_mm;
                AssemblyNode node;
                node.name = sources_.back()->name;
                node.unit = scaling(unit, unit, unit);
                node.location =
                    location(parts_[i], sources_.back()->line, fmt::format("object {}", sources_.back()->id));
                nodes_.push_back(std::move(node));
            }
        const auto make_use = [&](std::size_t part, const ThreeMfUse& use) {
            const std::size_t target = loader_.part_of(use, part);
            const ThreeMfModel& model = parts_[part];
            const auto node = numbers[target].find(use.object);
            if (node == numbers[target].end())
                throw Error(
                    ErrorKind::input,
                    fmt::format("{}, line {}: found objectid {}, but there is no such object{}", model.source,
                                use.line, use.object,
                                target == part
                                    ? ""
                                    : fmt::format(" in '{}'", printable(use.part, longest_file_name))));
            return AssemblyUse{node->second,
                               use.placement,
                               {model.part, use.line, "this use"},
                               sources_[node->second]->role,
                               {}};
        };
        std::size_t node = 0;
        for (std::size_t i = 0; i < parts_.size(); ++i)
            for (ThreeMfObject& object : parts_[i].objects) {
                nodes_[node].uses.reserve(object.components.size());
                for (const ThreeMfUse& component : object.components)
                    nodes_[node].uses.push_back(make_use(i, component));
                if (const auto known = config_.find(object.id); i == 0 && known != config_.end()) {
                    configure(object, nodes_[node], known->second);
                    config_.erase(known);
                }
                gaps_.compare(object.id, object.volumes, object.mesh.triangles.size());
                nodes_[node].is_body = nodes_[node].is_body || !object.volumes.empty();
                ++node;
            }
        for (const auto& [id, object] : config_)
            gaps_.add_absent(id, object);
        gaps_.report(remarks_);
        roots_.reserve(parts_[0].items.size());
        for (const ThreeMfUse& item : parts_[0].items) {
            AssemblyUse use = make_use(0, item);
            const ThreeMfObject& object = *sources_[use.node];
            if (use.role == MeshRole::other && !selection_.takes(use.role))
                throw Error(
                    ErrorKind::input,
                    fmt::format("{}, line {}: the build holds object {}, whose type 'other' says that it "
                                "is not to be made; `include` other to read it as a solid",
                                parts_[0].source, item.line, object.id));
            if (item.printable)
                roots_.push_back(std::move(use));
            else
                not_printed_.push_back(use.node);
        }
    }

    /// Applies a slicer's settings of the volumes or components of an object. Ids of components may repeat.
    void configure(ThreeMfObject& object, AssemblyNode& node, SlicerObject& known) {
        for (VolumeRange& volume : known.volumes)
            object.volumes.push_back(std::move(volume));
        std::vector<bool> used(known.parts.size());
        for (std::size_t i = 0; i < node.uses.size(); ++i) {
            std::size_t k = 0;
            while (k < known.parts.size() &&
                   (used[k] || known.parts[k].object != object.components[i].object))
                ++k;
            if (k == known.parts.size()) {
                if (!known.parts.empty())
                    gaps_.add_unlisted_component(object.id);
                continue;
            }
            used[k] = true;
            node.uses[i].role = known.parts[k].role;
            node.is_body = true;
            node.uses[i].name = std::move(known.parts[k].name);
        }
        for (std::size_t k = 0; k < known.parts.size(); ++k)
            if (!used[k])
                gaps_.add_absent(object.id, known.parts[k].role);
    }

    static std::string location(const ThreeMfModel& model, std::size_t line, std::string_view what) {
        return fmt::format("part '{}', line {}: {}", printable(model.part, longest_file_name), line, what);
    }

    /// Returns, for each node, whether it is one of these nodes or a component of them.
    [[nodiscard]] std::vector<bool> reached_from(std::vector<std::size_t> open) const {
        std::vector<bool> reached(nodes_.size());
        while (!open.empty()) {
            const std::size_t node = open.back();
            open.pop_back();
            if (reached[node])
                continue;
            reached[node] = true;
            for (const AssemblyUse& use : nodes_[node].uses)
                open.push_back(use.node);
        }
        return reached;
    }

    /// Removes uses of bodies that are not read. Uses with the same node and role count as one body.
    void select(std::vector<AssemblyUse>& uses) {
        std::erase_if(uses, [&](const AssemblyUse& use) {
            if (selection_.takes(use.role))
                return false;
            if (left_out_.emplace(use.node, use.role).second) {
                const ThreeMfObject& object = *sources_[use.node];
                const std::string& name = use.name.empty() ? object.name : use.name;
                selection_.leave_out(use.role, name);
                file_.bodies.push_back({name, use.role, object.mesh.triangles.size(), true});
            }
            return true;
        });
    }

    /// Removes uses of bodies that are not read. Returns the roles with which each node is then used.
    [[nodiscard]] std::vector<std::set<MeshRole>> selected() {
        std::vector<std::set<MeshRole>> roles(nodes_.size());
        std::vector<std::pair<std::size_t, MeshRole>> open;
        const auto follow = [&](std::vector<AssemblyUse>& uses, MeshRole outer) {
            select(uses);
            for (const AssemblyUse& use : uses)
                open.emplace_back(use.node, use.role != MeshRole::part ? use.role : outer);
        };
        follow(roots_, MeshRole::part);
        while (!open.empty()) {
            const auto [node, role] = open.back();
            open.pop_back();
            if (roles[node].insert(role).second)
                follow(nodes_[node].uses, role);
        }
        const auto take = [&](std::vector<AssemblyUse>& uses) {
            for (AssemblyUse& use : uses)
                use.role = selection_.taken_as(use.role);
        };
        take(roots_);
        for (AssemblyNode& node : nodes_)
            take(node.uses);
        return roles;
    }

    /// Adds the meshes of an object by role. `used` is the set of roles with which the object is used.
    void add_meshes(AssemblyNode& node, ThreeMfObject& source, const std::set<MeshRole>& used) {
        std::vector<MeshBody> bodies;
        for (RoleMesh& mesh : divided_by_role(std::move(source.mesh), source.volumes, source.name, selection_,
                                              bodies, limits_)) {
            node.meshes.push_back({file_.objects.size(), mesh.role});
            file_.stored_triangles += mesh.mesh.triangles.size();
            file_.objects.push_back({source.name, Mesh(std::move(mesh.mesh))});
        }
        for (const MeshRole role : used)
            for (MeshBody body : bodies) {
                body.role = body.role == MeshRole::part ? role : body.role;
                file_.bodies.push_back(std::move(body));
            }
    }

    /// Throws if the contents of an object only stand in for slices, or for an alternative that is not named.
    void refuse_substitute(const ThreeMfObject& object, const std::string& location) const {
        if (object.is_mesh && object.is_coarse)
            throw Error(
                ErrorKind::input,
                fmt::format("{}, {}: its mesh is of low resolution and only stands in for its slices; "
                            "slices are layers already: view, convert or verify them as they are",
                            package_.name(), location));
        if (!object.substitute.empty() && !object.is_substituted)
            throw Error(ErrorKind::input,
                        fmt::format("{}, {}: its resolution is '{}', so it only stands in for an object in "
                                    "full resolution, and the file does not say which; save the file with "
                                    "the full object",
                                    package_.name(), location, object.substitute));
    }

    /// Returns the error text for a build of which no mesh is read.
    [[nodiscard]] std::string nothing_to_slice() const {
        return selection_.left_out() != 0
                   ? fmt::format("holds nothing to slice: its only {} no material: {}",
                                 selection_.left_out() == 1 ? "body is" : "bodies are",
                                 selection_.description())
                   : "holds nothing to slice: no item of its build leads to a mesh that is a solid";
    }

    /// Adds the meshes that the build reaches, and their placements.
    void make_file() {
        if (parts_[0].items.empty())
            refuse_package(package_, "holds nothing to slice: its build is empty");
        std::vector<std::size_t> printed;
        for (const AssemblyUse& root : roots_)
            printed.push_back(root.node);
        const std::vector<bool> in_build = reached_from(std::move(printed));
        const std::vector<bool> kept_back = reached_from(not_printed_);
        const std::vector<std::set<MeshRole>> roles = selected();
        std::size_t empty = 0;
        std::size_t unused = 0;
        std::size_t degenerate = 0;
        for (std::size_t node = 0; node < nodes_.size(); ++node) {
            if (roles[node].empty()) {
                unused += in_build[node] || kept_back[node] ? 0 : 1;
                continue;
            }
            ThreeMfObject& source = *sources_[node];
            refuse_substitute(source, nodes_[node].location);
            if (!source.is_mesh)
                continue;
            if (source.mesh.triangles.empty()) {
                ++empty;
                continue;
            }
            degenerate += degenerate_triangles(source.mesh);
            add_meshes(nodes_[node], source, roles[node]);
        }
        if (empty != 0)
            remarks_.add(counted(empty, "object has a mesh without triangles",
                                 "objects have a mesh without triangles"));
        if (degenerate != 0)
            remarks_.add(counted(degenerate, "triangle uses a vertex twice; it bounds nothing",
                                 "triangles use a vertex twice; they bound nothing"));
        // Skipped bodies violate no rule, so they are not errors with `strict`.
        selection_.report(remarks_);
        const auto note_count = [&](std::size_t count, std::string_view thing, std::string_view what) {
            if (count == 1)
                remarks_.note(fmt::format("1 {} is {}; it was left out", thing, what));
            else if (count != 0)
                remarks_.note(fmt::format("{} {}s are {}; they were left out", count, thing, what));
        };
        note_count(not_printed_.size(), "item", "marked in the build as not to be printed");
        note_count(unused, "object", "not in the build");
        file_.instances = place_meshes(package_.name(), nodes_, roots_, file_.objects, limits_, executor_);
        if (file_.objects.empty())
            refuse_package(package_, nothing_to_slice());
        if (all_negative(file_.instances))
            refuse_package(package_, "holds nothing to slice: nothing but negative volumes; `include` "
                                     "negative to read them as solids");
    }

    ZipReader package_;
    Remarks remarks_;
    BodySelection selection_;
    ReadLimits limits_;
    Executor executor_;
    PartLoader loader_;
    std::vector<ThreeMfModel>& parts_ = loader_.parts();
    std::vector<AssemblyNode> nodes_;
    std::vector<ThreeMfObject*> sources_; ///< of each node
    std::vector<AssemblyUse> roots_;
    SlicerConfig config_; ///< of objects that are not yet found in the model
    RoleGaps gaps_;
    std::set<std::pair<std::size_t, MeshRole>> left_out_; ///< nodes
    std::vector<std::size_t> not_printed_;                ///< nodes of items that are not printed
    MeshFile file_;
};

} // namespace

MeshFile read_three_mf(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    return ThreeMfReader(source, false, options, execution).read();
}

std::optional<MeshFile> read_three_mf_without_slices(const ByteSource& source, const MeshReadOptions& options,
                                                     const Execution& execution) {
    try {
        return ThreeMfReader(source, true, options, execution).read();
    } catch (const MayHaveSlices&) {
        return std::nullopt;
    }
}

} // namespace lamella
