#include "lamella/pipeline/slice_file.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/mesh.hpp"

#include "core/executor.hpp"
#include "pipeline/plate_slicing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <span>
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

/// Parts are called by the name of their file.
const std::string& path_of(const Plate& plate, const PlatePart& part) {
    return plate.files[plate.shapes[part.shape].input].path;
}

void check_heights(const Plate& plate) {
    for (const PlatePart& part : plate.parts)
        if (part.box.min.z == part.box.max.z)
            throw Error(
                ErrorKind::input,
                fmt::format("{}: the mesh is flat: all of it lies at z = {:.6g}, so there is nothing to "
                            "slice; rotate it or choose another direction",
                            path_of(plate, part), part.box.min.z));
}

/// Whether a plane at z can cut anything of the box, by the rule of the plane.
bool meets(double z, PlaneRule rule, const Box3& box) {
    return rule == PlaneRule::section_above ? box.min.z <= z && z < box.max.z
                                            : box.min.z < z && z <= box.max.z;
}

/// Without the layers that nobody asked for.
Plan selected(const FileJob& job, Plan plan, const Box3& box) {
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

/// `listed`: of the heights that the job lists, if it does.
Plan plan_of(const FileJob& job, const Plate& plate, Plan listed, const Execution& execution) {
    const Box3& box = plate.box;
    if (!job.z.empty())
        return selected(job, std::move(listed), box);
    if (job.adaptive)
        return selected(job, plan_adaptive(joined(plate, execution), *job.adaptive, execution), box);
    if (!job.heights.empty())
        return selected(
            job,
            plan_by_ranges(box.min.z, box.max.z, job.heights, job.layers.layer_height, job.layers.slice_at),
            box);
    return uniform_plan(job, box);
}

/// What is gathered about the layers while they pass, in any order and from any thread.
class Gatherer {
  public:
    Gatherer(const Plan& plan, std::size_t parts, const FileJob& job)
        : first_(plan.layers.front().index), open_(plan.layers.size()), inside_out_(plan.layers.size()),
          gaps_(job.repair.close_gaps_mm ? plan.layers.size() : 0),
          layers_(job.layer_statistics ? plan.layers.size() : 0), changes_(plan.layers.size()),
          parts_(parts) {}

    /// `joins`: of the gaps that were closed in it.
    void add(std::span<const Layer> parts, std::vector<GapJoin> joins) {
        const Layer& first = parts.front();
        const auto place = static_cast<std::size_t>(first.index - first_);
        for (const GapJoin& join : joins) {
            FileResult::Gaps& gaps = gaps_[place];
            ++gaps.closed;
            gaps.longest_mm = std::max(gaps.longest_mm, join.length_mm);
            gaps.total_mm += join.length_mm;
        }
        LayerMeasure together;
        OpenGaps& open = open_[place];
        for (std::size_t i = 0; i < parts.size(); ++i) {
            const Layer& layer = parts[i];
            // In normal form the first ring has the smallest point of all, so nothing lies around it.
            open += open_gaps(layer);
            inside_out_[place] |= layer.rings > 0 && ring_area(layer.contour(0)) < 0;
            parts_[i].contours.fetch_add(layer.contours(), std::memory_order_relaxed);
            parts_[i].open_chains.fetch_add(layer.open_chains(), std::memory_order_relaxed);
            parts_[i].points.fetch_add(layer.points.size(), std::memory_order_relaxed);
            if (!layers_.empty())
                together.add(measure(layer));
        }
        if (!layers_.empty())
            layers_[place] = {.index = first.index,
                              .z = first.z,
                              .thickness = first.thickness(),
                              .measure = together,
                              .open_gaps = open,
                              .joins = std::move(joins),
                              .hash = content_hash(parts.size() == 1 ? first : merged(parts)),
                              .changes = changes_[place]};
    }

    /// Before the layers are added.
    void add(const Layer& layer, const LayerChanges& changes, double seconds) {
        changes_[static_cast<std::size_t>(layer.index - first_)] += changes;
        step_seconds_.fetch_add(seconds, std::memory_order_relaxed);
    }

    void finish(const Plan& plan, FileResult& result) {
        const auto count = [](bool affected, double z, FileResult::Affected& into) {
            if (affected && into.layers++ == 0)
                into.first_z = z;
        };
        for (std::size_t i = 0; i < open_.size(); ++i) {
            count(open_[i].count > 0, plan.layers[i].z, result.open);
            result.open_gaps += open_[i];
            count(inside_out_[i] != 0, plan.layers[i].z, result.inside_out);
        }
        for (std::size_t i = 0; i < gaps_.size(); ++i) {
            if (gaps_[i].closed == 0)
                continue;
            FileResult::Gaps& all = result.gaps;
            if (all.layers++ == 0)
                all.first_z = plan.layers[i].z;
            all.closed += gaps_[i].closed;
            all.longest_mm = std::max(all.longest_mm, gaps_[i].longest_mm);
            all.total_mm += gaps_[i].total_mm;
        }
        SliceReport& report = result.report;
        report.contours = report.open_chains = report.points = 0;
        for (std::size_t i = 0; i < parts_.size(); ++i) {
            PartResult& part = result.parts[i];
            report.contours += part.contours = parts_[i].contours;
            report.open_chains += part.open_chains = parts_[i].open_chains;
            report.points += part.points = parts_[i].points;
        }
        for (const LayerStatistics& layer : layers_)
            result.volume_mm3 += layer.measure.area_mm2 * layer.thickness;
        result.layers = std::move(layers_);
        if (result.changes)
            for (const LayerChanges& changes : changes_)
                *result.changes += changes;
        result.seconds.polygon = step_seconds_;
    }

  private:
    struct Counts {
        std::atomic<std::uint64_t> contours{0};
        std::atomic<std::uint64_t> open_chains{0};
        std::atomic<std::uint64_t> points{0};
    };
    std::uint64_t first_;
    std::vector<OpenGaps> open_;
    std::vector<unsigned char> inside_out_; ///< not bits: threads write to neighbours
    std::vector<FileResult::Gaps> gaps_;    ///< of each layer, where gaps are closed
    std::vector<LayerStatistics> layers_;
    std::vector<LayerChanges> changes_; // of all parts
    std::atomic<double> step_seconds_{0};
    std::vector<Counts> parts_;
};

/// The counts of all parts, each of which is a solid of its own.
Inspection together(const Plate& plate, const std::vector<Inspection>& shapes) {
    Inspection all;
    for (const PlatePart& part : plate.parts) {
        const Inspection& one = shapes[part.shape];
        all.box.add(part.box);
        all.volume_mm3 += one.volume_mm3;
        all.area_mm2 += one.area_mm2;
        all.triangles += one.triangles;
        all.vertices += one.vertices;
        all.boundary_edges += one.boundary_edges;
        all.nonmanifold_edges += one.nonmanifold_edges;
        all.orientation_conflicts += one.orientation_conflicts;
        all.duplicate_triangles += one.duplicate_triangles;
        all.degenerate_triangles += one.degenerate_triangles;
        all.shells += one.shells;
        all.cavities += one.cavities;
        all.inverted_shells += one.inverted_shells;
    }
    return all;
}

/// Inspects every shape, and leaves it welded for an engine that would weld it once more.
Inspection inspect_plate(Plate& plate, bool keep_welded, bool strict, const Execution& execution) {
    std::vector<Inspection> found;
    for (PlateShape& shape : plate.shapes) {
        IndexedMesh welded = weld(shape.mesh, execution);
        found.push_back(inspect(welded, execution));
        if (strict && !found.back().sound())
            throw Error(ErrorKind::defect,
                        fmt::format("{}: the mesh has defects: {}", plate.files[shape.input].path,
                                    describe_defects(found.back())));
        if (keep_welded)
            shape.mesh = Mesh(std::move(welded));
    }
    return together(plate, found);
}

/// Files of indexed meshes need not share the vertices that are equal; contours would end between them.
void join_vertices(Plate& plate, const Execution& execution) {
    for (PlateShape& shape : plate.shapes)
        if (shape.mesh.indexed() != nullptr)
            shape.mesh = Mesh(weld(*shape.mesh.indexed(), execution));
}

bool has_indexed(const Plate& plate) {
    return std::ranges::any_of(plate.shapes,
                               [](const PlateShape& shape) { return shape.mesh.indexed() != nullptr; });
}

/// The layers of all parts with their gaps closed.
std::vector<Layer> without_gaps(std::span<const Layer> parts, double within_mm, std::vector<GapJoin>& joins) {
    std::vector<Layer> closed;
    for (const Layer& layer : parts) {
        ClosedGaps result = close_gaps(layer, within_mm);
        joins.insert(joins.end(), result.joins.begin(), result.joins.end());
        closed.push_back(std::move(result.layer));
    }
    return closed;
}

void repair_plate(Plate& plate, const RepairPolicies& policies, FileResult& result,
                  const Execution& execution) {
    for (PlateShape& shape : plate.shapes) {
        FileResult::MeshRepair& done = result.repairs.emplace_back();
        done.file = shape.input;
        shape.mesh = repaired(shape.mesh, policies, done.repairs, execution);
        if (shape.mesh.empty())
            throw Error(ErrorKind::input, fmt::format("{}: nothing of the mesh is left after its repair",
                                                      plate.files[shape.input].path));
    }
}

LayerFileInfo file_info(const Plate& plate, const Plan& plan) {
    LayerFileInfo info{
        .box = plate.box, .layers = plan.layers.size(), .bottom = plan.layers.front().bottom, .parts = {}};
    for (const PlatePart& part : plate.parts)
        info.parts.push_back({part.label, part.box});
    return info;
}

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
    Plate plate = load_plate(
        job.inputs, {.strict = job.strict, .max_triangles = job.max_triangles, .max_memory = job.max_memory},
        execution);
    result.seconds.read = reading.seconds();
    check_heights(plate);
    if (job.build_volume)
        check_build_volume(plate, *job.build_volume);
    result.files = plate.files;
    result.box = plate.box;
    for (const PlatePart& part : plate.parts) {
        result.parts.push_back(
            {.label = part.label, .triangles = plate.shapes[part.shape].mesh.size(), .box = part.box});
        result.triangles += result.parts.back().triangles;
    }
    plan = plan_of(job, plate, std::move(plan), execution);
    result.bottom = plan.layers.front().bottom;
    result.top = plan.layers.back().top;

    const Stopwatch welding;
    const bool inspected = job.inspect || job.strict;
    const bool indexed = has_indexed(plate);
    if (indexed)
        join_vertices(plate, execution);
    if (inspected)
        result.inspection = inspect_plate(plate, with.welds, job.strict, execution);
    if (indexed || inspected)
        result.seconds.weld = welding.seconds();
    if (job.layer_statistics)
        for (const PlatePart& part : plate.parts)
            result.mesh_volume_mm3 += volume(plate.shapes[part.shape].mesh, execution);
    if (job.repair.change_the_mesh()) {
        const Stopwatch repairing;
        repair_plate(plate, job.repair, result, execution);
        result.seconds.weld += repairing.seconds();
    }

    std::unique_ptr<LayerWriter> writer;
    if (format != nullptr) {
        writer = open_layer_writer(job.output, *format, file_info(plate, plan), job.write);
        result.format = format->name;
    }
    Gatherer gatherer(plan, plate.parts.size(), job);
    if (job.steps.any())
        result.changes.emplace();
    const PlateSink sink = [&](std::span<const Layer> sliced) -> std::function<void()> {
        std::span<const Layer> parts = sliced;
        std::vector<Layer> closed;
        std::vector<GapJoin> joins;
        if (job.repair.close_gaps_mm && std::ranges::any_of(parts, &Layer::open_chains)) {
            closed = without_gaps(parts, *job.repair.close_gaps_mm, joins);
            parts = closed;
        }
        std::vector<Layer> made;
        if (job.steps.any()) {
            for (const Layer& layer : parts) {
                const Stopwatch stepping;
                LayerChanges changes;
                made.push_back(take_steps(job.steps, layer, changes));
                gatherer.add(layer, changes, stepping.seconds());
            }
            parts = made;
        }
        gatherer.add(parts, std::move(joins));
        if (writer == nullptr)
            return {};
        return [&result, write = writer->prepare(parts)] {
            const Stopwatch writing;
            write();
            result.seconds.write += writing.seconds();
        };
    };
    slice_plate_to(sink, plate, plan, execution, result.report, with);
    gatherer.finish(plan, result);
    if (job.strict && result.report.open_chains > 0)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: {} contours do not close, the lowest at z = {:.6g} mm",
                                job.inputs.front().path, result.report.open_chains, result.open.first_z));
    if (writer != nullptr) {
        const Stopwatch writing;
        writer->finish();
        result.seconds.write += writing.seconds();
        result.bytes = writer->bytes();
        result.warnings = writer->warnings();
    }
    result.seconds.weld += result.report.weld_seconds;
    result.seconds.link = result.report.link_seconds;
    result.seconds.slice = result.report.slice_seconds;
    result.seconds.total = total.seconds();
    return result;
}

} // namespace lamella
