#include "lamella/core/error.hpp"

#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "container/text_position.hpp"
#include "container/zip_reader.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "mesh/singular.hpp"
#include "meshes/amf_document.hpp"
#include "meshes/assembly.hpp"
#include "meshes/body_selection.hpp"
#include "meshes/mesh_readers.hpp"
#include "meshes/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t longest_quote = 200;

class AmfReader {
  public:
    AmfReader(const ByteSource& source, const MeshReadOptions& options, const Execution& execution)
        : name_(source.name), remarks_(source.name, options.strict), selection_(options.include),
          limits_(source, options), execution_(execution), executor_(execution) {
        source_ = is_zip(source.text()) ? unpacked(source, options) : source;
    }

    MeshFile read() {
        read_document();
        make_nodes();
        make_file();
        file_.unit_mm = document_.unit_mm;
        file_.name = !document_.name.empty() ? document_.name : file_.objects.front().name;
        file_.warnings = remarks_.take();
        return std::move(file_);
    }

  private:
    using NodesById = std::map<std::string_view, std::size_t>;

    [[noreturn]] void fail(const std::string& what) const {
        throw Error(ErrorKind::input, fmt::format("{}: {}", name_, what));
    }

    ByteSource unpacked(const ByteSource& archive, const MeshReadOptions& options) {
        const ZipReader zip(archive, most_unpacked(options));
        for (const std::string& warning : zip.counted_warnings())
            remarks_.add(warning);
        const ZipEntry* found = nullptr;
        std::size_t count = 0;
        for (const ZipEntry& entry : zip.entries())
            if (lower_case(entry.name).ends_with(".amf") || lower_case(entry.name).ends_with(".amf.xml")) {
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
                                     printable(found->name, longest_quote)));
        return unpacked_entry(zip, *found, limits_, &executor_);
    }

    void read_document() {
        ProgressMeter progress(execution_, Stage::read, source_.text().size());
        document_ =
            read_amf_document(source_.text(), source_.name, executor_, limits_, [&](std::size_t read) {
                executor_.check_cancelled();
                progress.add(read);
            });
        progress.finish();
        source_.bytes = {};
        source_.owner.reset();
    }

    /// Makes a node of each object and each constellation.
    void make_nodes() {
        std::size_t uses = document_.objects.size() + document_.constellations.size(); // roots, at most
        for (const AmfConstellation& constellation : document_.constellations)
            uses += constellation.instances.size();
        count_assembly(document_.objects.size() + document_.constellations.size(), uses, limits_);
        const double unit = document_.unit_mm.value_or(1);
        std::vector<std::size_t> lines; // of nodes
        const auto add = [&](const auto& item, std::string_view what, NodesById& known) {
            const std::string location =
                fmt::format("line {}: {} '{}'", item.line, what, printable(item.id, longest_quote));
            if (!known.emplace(item.id, nodes_.size()).second)
                fail(fmt::format("{}: the id is there for the second time", location));
            nodes_.push_back({item.name, {}, scaling(unit, unit, unit), {}, location, false});
            lines.push_back(item.line);
        };
        NodesById objects;
        for (const AmfObject& object : document_.objects)
            add(object, "object", objects);
        NodesById constellations;
        for (const AmfConstellation& constellation : document_.constellations) {
            add(constellation, "constellation", constellations);
            if (objects.contains(constellation.id))
                remarks_.add(
                    fmt::format("{}: an object has the same id; instances of this id are of the object",
                                nodes_.back().location));
        }
        // Slic3r and its descendants number objects and constellations separately. There an instance refers
        // to an object.
        const auto node_of = [&](const AmfInstance& instance) {
            for (const NodesById* const known : {&objects, &constellations})
                if (const auto found = known->find(instance.object); found != known->end())
                    return found->second;
            fail(fmt::format("line {}: found objectid '{}', but there is nothing of that id", instance.line,
                             printable(instance.object, longest_quote)));
        };
        std::vector<bool> used(nodes_.size());
        for (std::size_t i = 0; i < document_.constellations.size(); ++i) {
            AssemblyNode& node = nodes_[document_.objects.size() + i];
            for (const AmfInstance& instance : document_.constellations[i].instances) {
                const std::size_t target = node_of(instance);
                used[target] = true;
                if (instance.number("printable", 1) == 0) {
                    ++not_printable_;
                    continue;
                }
                node.uses.push_back({target,
                                     placement(instance, unit),
                                     {{}, instance.line, "this instance"},
                                     MeshRole::part,
                                     {}});
            }
        }
        for (std::size_t i = 0; i < nodes_.size(); ++i)
            if (!used[i])
                roots_.push_back({i, {}, {{}, lines[i], "this object"}, MeshRole::part, {}});
        if (roots_.empty() && !nodes_.empty())
            fail("each constellation is a part of another, expected one that is not");
    }

    /// Returns the placement of an instance: scaled, mirrored, rotated about x, then y, then z, and
    /// translated.
    [[nodiscard]] Transform placement(const AmfInstance& instance, double unit) const {
        const double scale = instance.number("scale", 1);
        const auto factor = [&](std::string_view axis_scale, std::string_view mirror) {
            return scale * instance.number(axis_scale, 1) * (instance.number(mirror, 1) < 0 ? -1 : 1);
        };
        Transform map =
            scaling(factor("scalex", "mirrorx"), factor("scaley", "mirrory"), factor("scalez", "mirrorz"));
        if (singular(map))
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
            if (std::all_of(object.volumes.begin(), object.volumes.end(),
                            [](const VolumeRange& volume) { return volume.role == MeshRole::part; }))
                object.volumes.clear();
            nodes_[i].is_body = true;
            for (RoleMesh& mesh : divided_by_role(std::move(object.mesh), object.volumes, object.name,
                                                  selection_, file_.bodies, limits_)) {
                nodes_[i].meshes.push_back({file_.objects.size(), mesh.role});
                file_.stored_triangles += mesh.mesh.triangles.size();
                file_.objects.push_back({object.name, Mesh(std::move(mesh.mesh))});
            }
        }
        if (empty != 0)
            remarks_.add(counted(empty, "object has no triangle", "objects have no triangle"));
        if (degenerate != 0)
            remarks_.add(counted(degenerate, "triangle uses a vertex twice; it bounds nothing",
                                 "triangles use a vertex twice; they bound nothing"));
        if (document_.bent.count != 0)
            remarks_.note(fmt::format("line {}: edges and normals bend triangles; they were passed over, as "
                                      "all {} of them, and triangles are flat",
                                      document_.bent.first, document_.bent.count));
        selection_.report(remarks_);
        if (not_printable_ != 0)
            remarks_.note(counted(not_printable_, "instance is marked as not to be printed; it was left out",
                                  "instances are marked as not to be printed; they were left out"));
        file_.instances = place_meshes(name_, nodes_, roots_, file_.objects, limits_, executor_);
        if (file_.objects.empty())
            fail(selection_.left_out() != 0
                     ? fmt::format("holds nothing to slice: its only {} no material: {}",
                                   selection_.left_out() == 1 ? "body is" : "bodies are",
                                   selection_.description())
                     : "holds nothing to slice: no object with a triangle");
        if (file_.instances.empty())
            fail("holds nothing to slice: no instance leads to an object with a triangle");
        if (all_negative(file_.instances))
            fail("holds nothing to slice: nothing but negative volumes; `include` negative to read them as "
                 "solids");
    }

    std::string name_;
    Remarks remarks_;
    BodySelection selection_;
    ReadLimits limits_;
    const Execution& execution_;
    Executor executor_;
    ByteSource source_;
    AmfDocument document_;
    std::vector<AssemblyNode> nodes_; ///< objects, then constellations
    std::vector<AssemblyUse> roots_;
    std::size_t not_printable_ = 0;
    MeshFile file_;
};

} // namespace

bool is_amf(std::string_view text) {
    const std::string_view begin = after_blanks(text.substr(0, amf_root_within));
    return begin.starts_with('<') && begin.find("<amf") != std::string_view::npos;
}

MeshFile read_amf(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    return AmfReader(source, options, execution).read();
}

} // namespace lamella
