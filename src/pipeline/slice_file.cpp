#include "lamella/pipeline/slice_file.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "core/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>

namespace lamella {
namespace {

class Stopwatch {
  public:
    [[nodiscard]] double seconds() const {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
    }

  private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// "2 boundary edges, 1 inverted shell".
std::string describe_defects(const Inspection& found) {
    struct Count {
        std::uint64_t n;
        std::string_view one;
        std::string_view many;
    };
    const std::array<Count, 6> counts{{
        {found.boundary_edges, "boundary edge", "boundary edges"},
        {found.nonmanifold_edges, "edge with more than two triangles", "edges with more than two triangles"},
        {found.orientation_conflicts, "orientation conflict", "orientation conflicts"},
        {found.duplicate_triangles, "duplicate triangle", "duplicate triangles"},
        {found.degenerate_triangles, "degenerate triangle", "degenerate triangles"},
        {found.inverted_shells, "inverted shell", "inverted shells"},
    }};
    std::string text;
    for (const Count& count : counts)
        if (count.n != 0)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count.n,
                                count.n == 1 ? count.one : count.many);
    return text;
}

void check_box(const Box3& box, const std::string& path) {
    for (const double bound : {box.min.x, box.min.y, box.min.z, box.max.x, box.max.y, box.max.z})
        if (!std::isfinite(bound))
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: unit, scale and translation move the mesh beyond the largest number; "
                            "choose smaller ones",
                            path));
    if (box.min.z == box.max.z)
        throw Error(ErrorKind::input,
                    fmt::format("{}: the mesh is flat: all of it lies at z = {:.6g}, so there is nothing to "
                                "slice; rotate it or choose another direction",
                                path, box.min.z));
}

/// Whether a plane at z can cut anything of the box, by the rule of the plane.
bool meets(double z, PlaneRule rule, const Box3& box) {
    return rule == PlaneRule::section_above ? box.min.z <= z && z < box.max.z
                                            : box.min.z < z && z <= box.max.z;
}

Plan listed_plan(const FileJob& job, Plan plan, const Box3& box) {
    std::erase_if(plan.layers, [&](const PlannedLayer& layer) {
        const auto& z_range = job.layers.z_range;
        const auto& index_range = job.layers.index_range;
        return (z_range && !(z_range->first <= layer.z && layer.z <= z_range->second)) ||
               (index_range && !(index_range->first <= layer.index && layer.index < index_range->second));
    });
    if (std::ranges::none_of(plan.layers,
                             [&](const PlannedLayer& layer) { return meets(layer.z, plan.rule, box); }))
        throw Error(
            ErrorKind::usage,
            fmt::format("none of the planes meets the part, which reaches from z = {:.6g} to {:.6g} mm",
                        box.min.z, box.max.z));
    return plan;
}

Plan uniform_plan(const FileJob& job, const Box3& box) {
    const double height = box.max.z - box.min.z;
    if (job.layers.layer_height > height)
        throw Error(
            ErrorKind::usage,
            fmt::format("the layer height of {:.6g} mm is above the part's height of {:.6g} mm; choose "
                        "a smaller one, or check the unit of the file",
                        job.layers.layer_height, height));
    return plan_uniform(box.min.z, box.max.z, job.layers);
}

/// What is gathered about the layers while they pass, in any order and from any thread.
class Gatherer {
  public:
    Gatherer(const Plan& plan, bool statistics)
        : first_(plan.layers.front().index), signs_(plan.layers.size()),
          layers_(statistics ? plan.layers.size() : 0) {}

    void add(const Layer& layer) {
        const auto place = static_cast<std::size_t>(layer.index - first_);
        // In normal form the first ring has the smallest point of all, so nothing lies around it.
        signs_[place] = {.open = layer.open_chains() > 0,
                         .inside_out = layer.rings > 0 && ring_area(layer.contour(0)) < 0};
        if (!layers_.empty())
            layers_[place] = {layer.index, layer.z, layer.thickness(), measure(layer), content_hash(layer)};
    }

    void finish(const Plan& plan, FileResult& result) {
        const auto count = [](bool affected, double z, FileResult::Affected& into) {
            if (affected && into.layers++ == 0)
                into.first_z = z;
        };
        for (std::size_t i = 0; i < signs_.size(); ++i) {
            count(signs_[i].open, plan.layers[i].z, result.open);
            count(signs_[i].inside_out, plan.layers[i].z, result.inside_out);
        }
        for (const LayerStatistics& layer : layers_)
            result.volume_mm3 += layer.measure.area_mm2 * layer.thickness;
        result.layers = std::move(layers_);
    }

  private:
    struct Signs {
        bool open = false;
        bool inside_out = false;
    };
    std::uint64_t first_;
    std::vector<Signs> signs_;
    std::vector<LayerStatistics> layers_;
};

} // namespace

FileResult slice_file(const FileJob& job, const Execution& execution) {
    const Stopwatch total;
    FileResult result;

    // What can be wrong with the wishes shows before a large file is read.
    const Engine& with = job.engine.empty() ? engines().front() : engine(job.engine);
    const LayerFormat* format = job.output.empty() ? nullptr : &layer_format(job.format, job.output);
    Plan plan;
    if (!job.z.empty())
        plan = plan_listed(job.z, job.layers.slice_at);
    result.engine = with.name;
    result.threads = thread_count(execution);

    const Stopwatch reading;
    MeshFile file = read_mesh(job.input, {.strict = job.strict}, execution);
    const Mesh mesh = file.mesh(execution).transformed(job.placement);
    result.box = bounding_box(mesh, execution);
    result.seconds.read = reading.seconds();
    result.mesh_format = file.format;
    result.triangles = file.stored_triangles;
    result.warnings = std::move(file.warnings);
    check_box(result.box, job.input);
    plan = job.z.empty() ? uniform_plan(job, result.box) : listed_plan(job, std::move(plan), result.box);
    result.bottom = plan.layers.front().bottom;
    result.top = plan.layers.back().top;
    if (job.layer_statistics)
        result.mesh_volume_mm3 = volume(mesh, execution);

    std::optional<IndexedMesh> welded; // for engines that would weld it once more
    if (job.inspect || job.strict) {
        const Stopwatch welding;
        IndexedMesh indexed = weld(mesh, execution);
        result.inspection = inspect(indexed, execution);
        if (with.welds)
            welded = std::move(indexed);
        result.seconds.weld = welding.seconds();
        if (job.strict && !result.inspection->sound())
            throw Error(ErrorKind::defect, fmt::format("{}: the mesh has defects: {}", job.input,
                                                       describe_defects(*result.inspection)));
    }

    std::unique_ptr<LayerWriter> writer;
    if (format != nullptr) {
        const LayerFileInfo info{.box = result.box,
                                 .layers = plan.layers.size(),
                                 .bottom = result.bottom,
                                 .parts = {{job.label, result.box}}};
        writer = open_layer_writer(job.output, *format, info, job.write);
        result.format = format->name;
    }
    Gatherer gatherer(plan, job.layer_statistics);
    const LayerSink sink = [&](Layer&& layer) -> std::function<void()> {
        gatherer.add(layer);
        if (writer == nullptr)
            return {};
        return [&result, write = writer->prepare(layer)] {
            const Stopwatch writing;
            write();
            result.seconds.write += writing.seconds();
        };
    };
    slice_to(sink, welded ? MeshRef(*welded) : MeshRef(mesh), plan, execution, &result.report, with);
    gatherer.finish(plan, result);
    if (job.strict && result.report.open_chains > 0)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: {} contours do not close, the lowest at z = {:.6g} mm", job.input,
                                result.report.open_chains, result.open.first_z));
    if (writer != nullptr) {
        const Stopwatch writing;
        writer->finish();
        result.seconds.write += writing.seconds();
        result.bytes = writer->bytes();
    }
    result.seconds.weld += result.report.weld_seconds;
    result.seconds.link = result.report.link_seconds;
    result.seconds.slice = result.report.slice_seconds;
    result.seconds.total = total.seconds();
    return result;
}

} // namespace lamella
