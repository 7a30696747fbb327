#include "jobs/file_slicer.hpp"

#include "lamella/contour/close_gaps.hpp"
#include "lamella/core/error.hpp"
#include "lamella/jobs/layer_findings.hpp"
#include "lamella/jobs/scan_layers.hpp"
#include "lamella/mesh/inspect.hpp"
#include "lamella/polygon/layer_steps.hpp"

#include "core/executor.hpp"
#include "core/progress.hpp"
#include "core/stopwatch.hpp"
#include "jobs/layer_cuts.hpp"
#include "jobs/plate_builder.hpp"
#include "jobs/plate_names.hpp"
#include "jobs/plate_slicing.hpp"
#include "mesh/edge_survey.hpp"

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
                    .check = job.check,
                    .image_cuts = job.image_cuts,
                    .statistics = job.layer_statistics,
                    .limits = limits};
    layers.steps.bottom.plate_mm = plate.box.min.z;
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

PreparedMeshes prepare(Plate& plate, const FileJob& job, const Engine& engine, const Execution& execution) {
    PreparedMeshes done;
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

void check_image_cuts(const FileJob& job) {
    if (job.image_cuts < 1 || job.image_cuts > most_antialias)
        throw Error(ErrorKind::usage, fmt::format("{} cuts for the image of a layer: choose 1 to {}",
                                                  job.image_cuts, most_antialias));
    if (job.output.empty() || !layer_format(job.format, job.output).image)
        throw Error(ErrorKind::usage, "several cuts for the image of a layer need an output in a format of "
                                      "images, such as png");
    if (job.scan || job.shard)
        throw Error(ErrorKind::usage,
                    fmt::format("several cuts for the image of a layer and `{}` exclude each other",
                                job.scan ? "scan" : "shard"));
}

/// Throws Error{usage} for an impossible job, before any large file is read.
void check_job(const FileJob& job) {
    check_inputs(job.inputs);
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
    if (job.image_cuts != 1)
        check_image_cuts(job);
    if (job.check) {
        check(*job.check);
        if (job.shard)
            throw Error(ErrorKind::usage, "the check of a print needs all layers, not those of a shard");
    }
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
    const Finding* found = result.findings.first(Severity::warning);
    if (found == nullptr && result.check)
        found = result.check->findings.first(Severity::warning);
    if (found != nullptr)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: {}",
                                found->file == Finding::all_files ? name_of(job.inputs)
                                                                  : result.files[found->file].path,
                                found->text()));
}

const Engine& checked_engine(const FileJob& job) {
    check_job(job);
    return job.engine.empty() ? engines().front() : engine(job.engine);
}

} // namespace

FileSlicer::FileSlicer(const FileJob& job, const Execution& execution, SharedReading* shared,
                       const Shard& process)
    : job_(job), execution_(execution), engine_(checked_engine(job)), feed_(job, engine_, execution, shared) {
    plan(process);
}

FileSlicer::FileSlicer(const FileJob& job, Plate plate, const Execution& execution)
    : job_(job), execution_(execution), engine_(checked_engine(job)), feed_(job, std::move(plate)) {
    plan({});
}

void FileSlicer::plan(const Shard& process) {
    result_.seconds.read = total_.seconds();
    result_.engine = engine_.name;
    result_.threads = thread_count(execution_);
    const Plate& plate = feed_.plate();
    check_heights(plate);
    if (job_.build_volume)
        check_build_volume(plate, *job_.build_volume);
    planes_ = plan_job(job_, plate, execution_);
    if (Plate* const meshes = feed_.meshes())
        prepared_ = prepare(*meshes, job_, engine_, execution_);
    mine_ = divide(job_, planes_, feed_, process, execution_);
    all_ = job_.shard ? mine_ : planes_.written;
    limits_ = layer_limits(execution_, feed_.memory().limit, feed_.memory().asked ? result_.threads : 1);
}

OutputFiles FileSlicer::files() const {
    OutputFiles files = output_files(job_);
    files.write.limits = limits_;
    return files;
}

LayerFileInfo FileSlicer::info() const {
    return file_info(job_, feed_.plate(), planes_.plan, all_);
}

void FileSlicer::slice(JobOutput& output) {
    const std::span<const PlannedLayer> layers = planes_.plan.layers;
    const PlaneRange sliced = with_neighbours(job_, mine_, layers.size());
    LayerProcessor& processor =
        processor_.emplace(layer_job(job_, feed_.plate(), limits_), layers, sliced, mine_, output);
    const double seconds = slice_ranges(planes_.sliced(sliced), processor);
    processor.set_times(result_.seconds);
    result_.seconds.weld = prepared_.seconds;
    if (feed_.meshes() == nullptr)
        result_.seconds.read = feed_.figures().read_seconds;
    figures_ = feed_.figures();
    figures_.planes = mine_.size();
    figures_.points = processor.totals().points();
    figures_.slice_seconds = seconds;
}

/// Slices planes range by range into the processor. Returns the seconds.
double FileSlicer::slice_ranges(PlaneRange sliced, LayerProcessor& processor) {
    const Plan& plan = planes_.sliced();
    const std::uint64_t first = plan.layers.front().index;
    std::optional<CutCollector> collector;
    if (planes_.cuts)
        collector.emplace(planes_.plan, *planes_.cuts);
    const PlateSink sink{.prepare = [&](Plane bodies) {
        const auto plane = static_cast<std::uint32_t>(bodies.polylines.front().index - first);
        if (!collector)
            return processor.prepare(plane, std::move(bodies));
        std::optional<Plane> layer = collector->add(plane, std::move(bodies));
        return layer ? processor.prepare(planes_.layer_of(plane), std::move(*layer)) : Commit();
    }};
    const ShapeVisitor visitor = near_face_visitor(feed_, plan);
    const std::vector<PlaneRange> ranges = feed_.bring(plan, sliced, execution_);
    result_.ranges = feed_.in_ranges() ? ranges.size() : 0;
    const std::uint64_t points_in_flight = feed_.memory().points_in_flight(
        feed_.in_memory() && feed_.plate().shapes.size() == 1 ? feed_.triangles(0) : 0);
    const Stopwatch slicing;
    for (std::size_t s = 0; s < ranges.size(); ++s) {
        const bool whole = ranges.size() == 1 && feed_.in_memory();
        const SliceOptions options{.execution = whole ? execution_ : in_range(ranges[s], sliced, execution_),
                                   .engine = engine_,
                                   .points_in_flight = points_in_flight};
        result_.report += slice_plate_to(sink, feed_.take(s, execution_), part_of(plan, ranges[s]), options,
                                         job_.scan ? SinkCost::expanding : SinkCost::proportional, visitor);
    }
    if (visitor && ranges.empty()) // near faces of all planes are counted
        for (std::size_t shape = 0; shape < feed_.plate().shapes.size(); ++shape) {
            const Mesh& mesh = feed_.plate().shapes[shape].mesh;
            visitor(shape, mesh, 0, mesh.size());
        }
    return slicing.seconds();
}

void FileSlicer::move_to(Packer& message) {
    SliceReport& report = result_.report;
    message.put(result_.seconds)
        .put(report.weld_seconds)
        .put(report.link_seconds)
        .put(report.slice_seconds)
        .put(report.matching.value_or(MatchingCounts{}))
        .put(result_.ranges);
    if (report.matching)
        report.matching.emplace();
    result_.ranges = 0;
    processor_->totals().move_to(message);
}

void FileSlicer::add(Unpacker& message) { // in the order of put()
    SliceReport& report = result_.report;
    const auto seconds = message.get<FileResult::Seconds>();
    for (double FileResult::Seconds::*stage :
         {&FileResult::Seconds::read, &FileResult::Seconds::weld, &FileResult::Seconds::polygon,
          &FileResult::Seconds::scan, &FileResult::Seconds::format, &FileResult::Seconds::write,
          &FileResult::Seconds::order})
        result_.seconds.*stage = std::max(result_.seconds.*stage, seconds.*stage);
    for (double SliceReport::*time :
         {&SliceReport::weld_seconds, &SliceReport::link_seconds, &SliceReport::slice_seconds})
        report.*time = std::max(report.*time, message.get<double>());
    if (const auto matching = message.get<MatchingCounts>(); report.matching)
        *report.matching += matching;
    result_.ranges += message.get<std::uint64_t>();
    processor_->totals().add(message);
}

/// Sets what is known of the job besides its layers.
void FileSlicer::describe_job() {
    const Plate& plate = feed_.plate();
    result_.files = plate.files;
    result_.box = plate.box;
    for (const PlatePart& part : plate.parts) {
        result_.parts.push_back({.label = part.label,
                                 .file = plate.shapes[part.shape].input,
                                 .triangles = feed_.triangles(part.shape),
                                 .box = part.box});
        result_.triangles += result_.parts.back().triangles;
    }
    result_.mesh_volume_mm3 = feed_.meshes() != nullptr ? prepared_.volume_mm3 : feed_.volume_mm3();
    result_.inspection = prepared_.inspection;
    result_.unsound = prepared_.unsound;
    result_.repairs = std::move(prepared_.repairs);
    const PlaneRange written = planes_.written;
    result_.planned_layers = written.size();
    result_.shard = {all_.begin - written.begin, all_.end - written.begin};
    result_.bottom = planes_.plan.layers[all_.begin].bottom;
    result_.top = planes_.plan.layers[all_.end - 1].top;
}

FileResult FileSlicer::finish(JobOutput& output) {
    describe_job();
    LayerTotals& totals = processor_->totals();
    for (const Feed::NearPlane& near : feed_.near_faces())
        if (const std::uint32_t layer = planes_.layer_of(near.plane); all_.begin <= layer && layer < all_.end)
            totals.add({.kind = FindingKind::near_faces,
                        .file = static_cast<std::uint32_t>(near.file),
                        .part = PlaneFinding::no_part,
                        .plane = layer - all_.begin,
                        .count = 1,
                        .amount = near.area_mm2,
                        .largest = near.farthest_mm});
    totals.store_in(result_);
    result_.check = processor_->take_check();
    if (!job_.shard) // if a shard has no contours, other shards may still have some
        add_missing_contours(result_);
    refuse_defects(job_, result_);

    const Stopwatch writing;
    output.finish_file(result_);
    result_.seconds.end = figures_.write_seconds = writing.seconds();
    result_.seconds.weld += result_.report.weld_seconds;
    result_.seconds.link = result_.report.link_seconds;
    result_.seconds.slice = result_.report.slice_seconds;
    result_.processes = {figures_};
    if (output.has_page())
        try {
            result_.report_losses =
                output.finish_page(job_.report.notes ? job_.report.notes(result_) : PageNotes{});
        } catch (const Error& error) {
            if (job_.output.empty() || job_.output == "-")
                throw;
            throw Error(error.kind(), fmt::format("{}; {} is complete", error.what(), job_.output),
                        error.system_error());
        }
    result_.seconds.total = total_.seconds();
    return std::move(result_);
}

} // namespace lamella
