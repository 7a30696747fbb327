#include "lamella/pipeline/slice_file.hpp"

#include "lamella/contour/close_gaps.hpp"
#include "lamella/core/error.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/pipeline/layer_findings.hpp"
#include "lamella/pipeline/scan_layers.hpp"
#include "lamella/polygon/layer_steps.hpp"

#include "core/executor.hpp"
#include "core/progress.hpp"
#include "core/stopwatch.hpp"
#include "mesh/edge_survey.hpp"
#include "pipeline/agreement.hpp"
#include "pipeline/feed.hpp"
#include "pipeline/job_output.hpp"
#include "pipeline/job_plan.hpp"
#include "pipeline/layer_processor.hpp"
#include "pipeline/packed.hpp"
#include "pipeline/plate_builder.hpp"
#include "pipeline/plate_names.hpp"
#include "pipeline/plate_slicing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace lamella {
namespace {

/// Returns a box that contains the layers of a body in `box` after the steps. The result is not tight, since
/// only sharp corners move farther than the sides, and open chains do not move.
Box3 box_after(const LayerSteps& steps, Box3 box) {
    const bool mitre = steps.offset_corners.shape == OffsetCorner::mitre;
    const double reach = std::max(0.0, steps.offset_mm) * (mitre ? steps.offset_corners.longest_mitre() : 1);
    box.min.x -= reach;
    box.min.y -= reach;
    box.max.x += reach;
    box.max.y += reach;
    return box;
}

/// Returns the header of the slice file.
LayerFileInfo file_info(const FileJob& job, const Plate& plate, const Plan& plan, PlaneRange written) {
    LayerFileInfo info{.box = box_after(job.steps, plate.box),
                       .layers = written.size(),
                       .bottom = plan.layers[written.begin].bottom,
                       .parts = {}};
    for (const PlatePart& part : plate.parts)
        info.parts.push_back(
            {.label = part.label, .box = box_after(job.steps, part.box), .support = part.support});
    info.rule = plan.rule;
    info.known_finite = true;
    return job.scan ? with_exposures(info, *job.scan) : info;
}

OutputFiles output_files(const FileJob& job) {
    return {.path = job.output,
            .format = job.output.empty() ? nullptr : &layer_format(job.format, job.output),
            .write = job.write,
            .page_path = job.report.path,
            .page = job.report.page};
}

LayerJob layer_job(const FileJob& job, const Plate& plate, const LayerLimits& limits) {
    LayerJob layers{.names = names_of_parts(plate),
                    .negatives = plate.negatives,
                    .written = output_files(job).rounding(),
                    .close_gaps_mm = job.repair.close_gaps_mm,
                    .steps = job.steps,
                    .scan = job.scan,
                    .statistics = job.layer_statistics,
                    .limits = limits};
    const auto add_file = [&](std::size_t shape) {
        layers.files.push_back(static_cast<std::uint32_t>(plate.shapes[shape].input));
    };
    for (const PlatePart& part : plate.parts) {
        layers.supports.push_back(part.support);
        layers.objects.push_back(static_cast<std::uint32_t>(part.object));
        add_file(part.shape);
    }
    for (const PlateNegative& negative : plate.negatives)
        add_file(negative.shape);
    return layers;
}

/// Inspects every shape. With `keep_welded` the shapes stay welded, so that an engine that welds need not
/// weld again. Returns the sums over all parts. Each part counts as a solid of its own.
Inspection inspect_plate(Plate& plate, bool keep_welded, bool strict, std::vector<std::size_t>& unsound,
                         const Execution& execution) {
    std::vector<Inspection> found;
    for (std::size_t i = 0; i < plate.shapes.size(); ++i) {
        PlateShape& shape = plate.shapes[i];
        IndexedMesh welded = weld(shape.mesh, execution);
        found.push_back(inspect(welded, execution));
        if (strict && !found.back().sound())
            throw Error(ErrorKind::defect,
                        fmt::format("{}: the mesh has defects: {}", name_of_shape(plate, i),
                                    describe_defects(found.back())));
        if (!found.back().sound() && (unsound.empty() || unsound.back() != shape.input))
            unsound.push_back(shape.input);
        if (keep_welded)
            shape.mesh = Mesh(std::move(welded));
    }
    Inspection all;
    for (const PlatePart& part : plate.parts) {
        Inspection one = found[part.shape];
        one.box = part.box;
        add(all, one);
    }
    for (const PlateNegative& negative : plate.negatives)
        for (const DefectKind& kind : defect_kinds)
            all.*kind.count += found[negative.shape].*kind.count;
    return all;
}

/// Defects and repairs of the meshes before they were sliced.
struct Prepared {
    std::optional<Inspection> inspection;
    std::vector<std::size_t> unsound; ///< indices of files
    std::vector<FileResult::MeshRepair> repairs;
    double volume_mm3 = 0;
    double seconds = 0; ///< without computing the volume
};

Prepared prepare(Plate& plate, const FileJob& job, const Engine& engine, const Execution& execution) {
    Prepared done;
    const Stopwatch welding;
    const bool inspected = job.inspect || job.strict;
    const bool indexed = std::any_of(plate.shapes.begin(), plate.shapes.end(),
                                     [](const PlateShape& shape) { return shape.mesh.indexed() != nullptr; });
    // Slicing would weld the vertices, too; welding here frees the unwelded mesh.
    for (PlateShape& shape : plate.shapes)
        shape.mesh = shape.mesh.with_joined_vertices(execution);
    if (inspected)
        done.inspection = inspect_plate(plate, engine.welds, job.strict, done.unsound, execution);
    if (indexed || inspected)
        done.seconds = welding.seconds();
    if (job.layer_statistics) {
        std::vector<double> volumes;
        for (const PlateShape& shape : plate.shapes)
            volumes.push_back(volume(shape.mesh, execution));
        for (const PlatePart& part : plate.parts)
            done.volume_mm3 += volumes[part.shape];
    }
    if (job.repair.change_the_mesh()) {
        const Stopwatch repairing;
        RepairedPlate whole = repaired(std::move(plate), job.repair, execution);
        plate = std::move(whole.plate);
        for (std::size_t i = 0; i < plate.shapes.size(); ++i)
            done.repairs.push_back({plate.shapes[i].input, std::move(whole.repairs[i])});
        done.seconds += repairing.seconds();
    }
    return done;
}

/// Returns an execution that reports the planes of a range as a part of all planes. It reports no other
/// stage, since stages must not repeat for each range.
Execution in_range(PlaneRange range, PlaneRange mine, const Execution& execution) {
    return with_progress(execution, [range, mine](const Progress& progress) -> std::optional<Progress> {
        if (progress.stage != Stage::slice || progress.total == 0)
            return std::nullopt;
        const std::uint64_t done = progress.done * range.size() / progress.total;
        return Progress{Stage::slice, range.begin - mine.begin + done, mine.size()};
    });
}

/// Replaces times by the longest of all processes, since processes work at the same time, and counts by sums
/// over all processes.
void gather(Communicator& processes, FileResult::Seconds& seconds, SliceReport& report) {
    if (processes.size() == 1)
        return;
    const std::string mine = Packer()
                                 .put(seconds)
                                 .put(report.weld_seconds)
                                 .put(report.link_seconds)
                                 .put(report.slice_seconds)
                                 .put(report.matching.value_or(MatchingCounts{}))
                                 .take();
    if (report.matching)
        report.matching.emplace();
    for (const std::string& message : processes.gather(mine)) {
        Unpacker from(message);
        const auto other = from.get<FileResult::Seconds>();
        for (double FileResult::Seconds::*stage :
             {&FileResult::Seconds::read, &FileResult::Seconds::weld, &FileResult::Seconds::polygon,
              &FileResult::Seconds::scan, &FileResult::Seconds::format, &FileResult::Seconds::write,
              &FileResult::Seconds::order})
            seconds.*stage = std::max(seconds.*stage, other.*stage);
        for (double SliceReport::*time :
             {&SliceReport::weld_seconds, &SliceReport::link_seconds, &SliceReport::slice_seconds})
            report.*time = std::max(report.*time, from.get<double>());
        if (const auto matching = from.get<MatchingCounts>(); report.matching)
            *report.matching += matching;
    }
}

/// Throws Error{usage} for an impossible job, before any large file is read.
void check_job(const FileJob& job, Communicator& processes) {
    check_inputs(job.inputs);
    if (processes.size() > 1 && job.shard)
        throw Error(ErrorKind::usage,
                    "processes share out all layers among themselves, not those of a shard");
    if (processes.size() > 1 && !job.report.path.empty())
        throw Error(ErrorKind::usage,
                    "no process has all layers for a page of the run; write a slice file, and "
                    "let lamella view make a page of it");
    if (!job.output.empty())
        static_cast<void>(layer_format(job.format, job.output));
    if (const auto* const listed = std::get_if<ListedPlanes>(&job.layering.cut))
        check_list(listed->z);
    if (job.repair.weld_tolerance_mm)
        static_cast<void>(weld_within({}, *job.repair.weld_tolerance_mm));
    if (job.repair.close_gaps_mm)
        static_cast<void>(close_gaps({}, *job.repair.close_gaps_mm));
    check_steps(job.steps);
    if (job.scan)
        check_strategy(*job.scan);
}

/// Returns the visitor that finds near faces among the sliced triangles. It is empty if triangles stay in
/// their files, because `Feed::count` then finds the near faces, or if there can be none.
ShapeVisitor near_face_visitor(Feed& feed, const Plan& plan) {
    if (feed.meshes() == nullptr)
        return {};
    feed.begin_near_faces(plan);
    if (!feed.may_have_near_faces())
        return {};
    return [&feed](std::size_t shape, const Mesh& mesh, std::uint64_t begin, std::uint64_t end) {
        feed.show_near_faces(shape, mesh, begin, end);
    };
}

struct Sliced {
    SliceReport report;
    std::uint64_t ranges = 0; ///< of this process
    double seconds = 0;       ///< without waiting for other processes
};

/// Slices the planes of this process, range by range, into the processor. `sliced` lists the planes that each
/// process slices.
Sliced slice_ranges(Feed& feed, const Plan& plan, std::span<const PlaneRange> sliced, const Engine& engine,
                    LayerProcessor& processor, SinkCost cost, Communicator& processes,
                    const Execution& execution) {
    Sliced done;
    const std::uint64_t first = plan.layers.front().index;
    const PlateSink sink{.prepare = [&processor, first](std::span<const Layer> parts) {
        return processor.prepare(static_cast<std::uint32_t>(parts.front().index - first), parts);
    }};
    const ShapeVisitor visitor = near_face_visitor(feed, plan);
    const std::vector<PlaneRange> ranges = feed.bring(plan, sliced, execution);
    done.ranges = ranges.size();
    const std::uint64_t points_in_flight = feed.memory().points_in_flight(
        feed.in_memory() && feed.plate().shapes.size() == 1 ? feed.triangles(0) : 0);
    in_agreement(processes, [&] {
        const Stopwatch slicing;
        for (std::size_t s = 0; s < ranges.size(); ++s) {
            const bool whole = ranges.size() == 1 && feed.in_memory();
            const Plan planes = part_of(plan, ranges[s]);
            const SliceOptions options{
                .execution = whole ? execution : in_range(ranges[s], sliced[processes.process()], execution),
                .engine = engine,
                .points_in_flight = points_in_flight};
            done.report += slice_plate_to(sink, feed.take(s, execution), planes, options, cost, visitor);
        }
        if (visitor && ranges.empty()) // all processes count near faces
            for (std::size_t shape = 0; shape < feed.plate().shapes.size(); ++shape) {
                const Mesh& mesh = feed.plate().shapes[shape].mesh;
                visitor(shape, mesh, 0, mesh.size());
            }
        done.seconds = slicing.seconds();
    });
    return done;
}

/// Adds a finding if the job has no contour at all.
void add_missing_contours(FileResult& result) {
    const std::uint64_t layers = result.report.layers;
    if (result.changes)
        add_nothing_left(result.findings, *result.changes, layers, result.report.contours);
    if (result.report.contours == 0 && result.findings.of(FindingKind::nothing_left).count == 0)
        result.findings.add({.kind = FindingKind::no_contours,
                             .file = Finding::all_files,
                             .count = 1,
                             .layers = layers,
                             .of_layers = layers});
}

/// Throws Error{defect} for the first sign of a defect, if the job is strict.
void refuse_defects(const FileJob& job, const FileResult& result) {
    if (!job.strict)
        return;
    if (const Finding* found = result.findings.first_warning(); found != nullptr)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: {}",
                                found->file == Finding::all_files ? name_of(job.inputs)
                                                                  : result.files[found->file].path,
                                found->text()));
}

/// Slices a job. `feed_of` opens the files; it is called after the job has been checked.
FileResult slice_job(const FileJob& job, Communicator& processes, const Execution& execution,
                     const std::function<Feed(const Engine& engine)>& feed_of) {
    const Stopwatch total;
    FileResult result;
    check_job(job, processes);
    const Engine& engine = job.engine.empty() ? engines().front() : lamella::engine(job.engine);
    result.engine = engine.name;
    result.threads = thread_count(execution);

    const Stopwatch reading;
    Feed feed = feed_of(engine);
    result.seconds.read = reading.seconds();
    const Plate& plate = feed.plate();

    JobPlan planes;
    Prepared prepared;
    in_agreement(processes, [&] {
        check_heights(plate);
        if (job.build_volume)
            check_build_volume(plate, *job.build_volume);
        planes = plan_job(job, plate, execution);
        if (Plate* const meshes = feed.meshes())
            prepared = prepare(*meshes, job, engine, execution);
    });
    const Plan& plan = planes.plan;
    const std::vector<PlaneRange> division = divide(job, planes, feed, processes, execution);
    const PlaneRange mine = division[processes.process()];
    const PlaneRange all{division.front().begin, division.back().end};
    std::vector<PlaneRange> sliced;
    for (const PlaneRange& part : division)
        sliced.push_back(with_neighbours(job, part, plan.layers.size()));

    const LayerLimits limits =
        layer_limits(execution, feed.memory().limit, feed.memory().asked ? result.threads : 1);
    OutputFiles files = output_files(job);
    files.write.limits = limits;
    JobOutput output(files, file_info(job, plate, plan, all), {mine.begin - all.begin, mine.end - all.begin},
                     processes, feed.memory().of_output());
    LayerProcessor processor(layer_job(job, plate, limits), plan.layers, sliced[processes.process()], mine,
                             output);
    LayerTotals& totals = processor.totals();
    const Sliced done =
        slice_ranges(feed, plan, sliced, engine, processor,
                     job.scan ? SinkCost::expanding : SinkCost::proportional, processes, execution);

    result.report = done.report;
    result.files = plate.files;
    result.box = plate.box;
    for (const PlatePart& part : plate.parts) {
        result.parts.push_back({.label = part.label,
                                .file = plate.shapes[part.shape].input,
                                .triangles = feed.triangles(part.shape),
                                .box = part.box});
        result.triangles += result.parts.back().triangles;
    }
    result.mesh_volume_mm3 = feed.meshes() != nullptr ? prepared.volume_mm3 : feed.volume_mm3();
    result.inspection = prepared.inspection;
    result.unsound = prepared.unsound;
    result.repairs = std::move(prepared.repairs);
    result.planned_layers = planes.written.size();
    result.shard = {all.begin - planes.written.begin, all.end - planes.written.begin};
    result.bottom = plan.layers[all.begin].bottom;
    result.top = plan.layers[all.end - 1].top;
    std::uint64_t ranges_of_all = done.ranges;
    processes.sum(std::span(&ranges_of_all, 1));
    result.ranges = feed.in_ranges() ? ranges_of_all : 0;
    if (feed.meshes() == nullptr)
        result.seconds.read = feed.figures().read_seconds;
    result.seconds.weld = prepared.seconds;
    processor.set_times(result.seconds);

    ProcessFigures figures = feed.figures();
    figures.planes = mine.size();
    figures.points = totals.points();
    figures.slice_seconds = done.seconds;
    gather(processes, result.seconds, result.report);
    totals.gather(processes);
    for (const Feed::NearPlane& near : feed.near_faces())
        if (all.begin <= near.plane && near.plane < all.end)
            totals.add({.kind = FindingKind::near_faces,
                        .file = static_cast<std::uint32_t>(near.file),
                        .part = PlaneFinding::no_part,
                        .plane = near.plane - all.begin,
                        .count = 1,
                        .amount = near.area_mm2,
                        .largest = near.farthest_mm});
    totals.store_in(result);
    if (!job.shard) // if a shard has no contours, other shards may still have some
        add_missing_contours(result);
    refuse_defects(job, result);

    const Stopwatch writing;
    output.finish_file(result);
    figures.write_seconds = writing.seconds();
    result.seconds.end = figures.write_seconds;
    result.seconds.weld += result.report.weld_seconds;
    result.seconds.link = result.report.link_seconds;
    result.seconds.slice = result.report.slice_seconds;
    for (const std::string& message : processes.gather(Packer().put(figures).take()))
        result.processes.push_back(Unpacker(message).get<ProcessFigures>());
    if (output.has_page())
        try {
            result.report_warnings =
                output.finish_page(job.report.notes ? job.report.notes(result) : PageNotes{});
        } catch (const Error& error) {
            if (job.output.empty() || job.output == "-")
                throw;
            throw Error(error.kind(), fmt::format("{}; {} is complete", error.what(), job.output),
                        error.system_error());
        }
    result.seconds.total = total.seconds();
    return result;
}

} // namespace

FileResult slice_file(const FileJob& job, const Execution& execution, Communicator& processes) {
    return slice_job(job, processes, execution,
                     [&](const Engine& engine) { return Feed(job, engine, processes, execution); });
}

FileResult slice_file(const FileJob& job, Plate plate, const Execution& execution) {
    return slice_job(job, alone(), execution,
                     [&](const Engine&) { return Feed(job, std::move(plate), alone()); });
}

} // namespace lamella
