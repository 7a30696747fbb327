#include "lamella/pipeline/slice_file.hpp"

#include "lamella/core/error.hpp"
#include "lamella/core/printable.hpp"
#include "lamella/mesh/inspect.hpp"

#include "core/byte_amount.hpp"
#include "core/executor.hpp"
#include "core/naming.hpp"
#include "core/stopwatch.hpp"
#include "mesh/edge_survey.hpp"
#include "pipeline/agreement.hpp"
#include "pipeline/feed.hpp"
#include "pipeline/job_memory.hpp"
#include "pipeline/job_output.hpp"
#include "pipeline/layer_totals.hpp"
#include "pipeline/layer_window.hpp"
#include "pipeline/material_surface.hpp"
#include "pipeline/packed.hpp"
#include "pipeline/plane_scan.hpp"
#include "pipeline/plate_builder.hpp"
#include "pipeline/plate_names.hpp"
#include "pipeline/plate_slicing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace lamella {
namespace {

void check_heights(const Plate& plate) {
    for (std::size_t i = 0; i < plate.parts.size(); ++i) {
        const PlatePart& part = plate.parts[i];
        if (part.box.min.z != part.box.max.z)
            continue;
        const PlateFile& file = plate.files[plate.shapes[part.shape].input];
        // A warning of the reader may name the cause.
        const std::string cause = file.warnings.empty() ? "" : fmt::format(" ({})", file.warnings.front());
        throw Error(ErrorKind::input,
                    fmt::format("{}: the mesh is flat: all of it lies at z = {:.6g}, so there is nothing to "
                                "slice; rotate it or choose another direction{}",
                                name_of_part(plate, i), part.box.min.z, cause));
    }
}

/// Returns the path of a part's file, and the label of the part if there are several.
std::string name_of(const Plate& plate, const PlatePart& part) {
    const std::string& path = plate.files[plate.shapes[part.shape].input].path;
    return plate.parts.size() == 1 ? path : fmt::format("{}, part \"{}\"", path, excerpt(part.label));
}

/// Returns the part that determines the number of layers, as errors name it: "plate.3mf, part "axle"".
std::string highest_part(const Plate& plate) {
    const auto part =
        std::max_element(plate.parts.begin(), plate.parts.end(),
                         [](const PlatePart& a, const PlatePart& b) { return a.box.max.z < b.box.max.z; });
    return name_of(plate, *part);
}

/// Plans of this many layers take negligible memory.
constexpr std::uint32_t few_layers = 100'000;

/// Throws if the layer height exceeds the part, or if it makes more layers than fit into memory: a height in
/// the wrong unit may be a thousand times too small.
void check_layer_heights(const FileJob& job, const UniformLayers& layers, const Plate& plate) {
    const Box3& box = plate.box;
    const double height = box.max.z - box.min.z;
    const double layer_height = layers.layer_height;
    for (const double one : {layer_height, layers.first_layer_height.value_or(layer_height)})
        if (one > height)
            throw Error(
                ErrorKind::usage,
                fmt::format("{}: the layer height of {:.6g} mm is above the part's height of {:.6g} mm; "
                            "choose a smaller one, or check the unit of the file",
                            highest_part(plate), one, height));
    double count = height / layer_height;
    if (const auto& range = job.layering.only.z_range)
        count = std::min(count, (range->second - range->first) / layer_height);
    if (const auto& range = job.layering.only.index_range)
        count = std::min(count, static_cast<double>(range->second - range->first));
    constexpr double most = std::numeric_limits<std::int32_t>::max();
    if (!(count > few_layers && count <= most))
        return; // plan_uniform reports larger counts
    const JobMemory memory(job);
    const std::uint64_t bytes =
        JobMemory::overhead(1, static_cast<std::uint64_t>(count), 1, job.layer_statistics);
    if (bytes > memory.of_planes())
        throw Error(
            ErrorKind::limit,
            fmt::format(
                "{}: a layer height of {:.6g} mm makes {:.6g} layers of this part ({:.6g} mm high), which "
                "take {} of memory, above the {} {}; choose a larger one, or fewer layers",
                highest_part(plate), layer_height, count, height, byte_amount(bytes),
                byte_amount(memory.of_planes()),
                memory.asked ? "of `max_memory`" : "that layers may take unless `max_memory` says more"));
}

/// Throws if this number of planes takes too much memory.
void check_planes(const FileJob& job, const Plate& plate, std::uint64_t planes) {
    const JobMemory memory(job);
    const std::uint64_t bytes = JobMemory::overhead(1, planes, plate.shapes.size(), job.layer_statistics);
    if (bytes > memory.of_planes() && planes > few_layers)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: {} layers take {} of memory, above the {} {}; choose higher ones, or fewer",
                        highest_part(plate), planes, byte_amount(bytes), byte_amount(memory.of_planes()),
                        memory.asked ? "of `max_memory`"
                                     : "that layers may take unless `max_memory` says more"));
}

/// Returns the approximate number of layers. All of them are stacked, even those that are not selected.
double count_by_ranges(const HeightRanges& layers, double height) {
    double count = 0;
    double rest = height;
    for (const HeightRange& range : layers.ranges) {
        const double reach = std::max(0.0, std::min(range.to, height) - std::max(range.from, 0.0));
        count += reach / range.layer_height;
        rest -= reach;
    }
    return count + rest / layers.layer_height;
}

} // namespace

Plan plan_of(const FileJob& job, const Plate& plate, const Execution& execution) {
    check_heights(plate);
    if (const auto* const uniform = std::get_if<UniformLayers>(&job.layering.cut))
        check_layer_heights(job, *uniform, plate);
    if (const auto* const ranges = std::get_if<HeightRanges>(&job.layering.cut))
        if (const double count = count_by_ranges(*ranges, plate.box.max.z - plate.box.min.z);
            count > few_layers && count < std::numeric_limits<std::int32_t>::max())
            check_planes(job, plate, static_cast<std::uint64_t>(count));
    Plan plan;
    try {
        plan = plan_of(
            job.layering, plate.box, [&] { return material_surface(plate, execution); }, execution);
    } catch (const Error& error) {
        if (error.kind() != ErrorKind::usage && error.kind() != ErrorKind::limit)
            throw;
        throw Error(error.kind(), fmt::format("{}: {}", highest_part(plate), error.what()));
    }
    check_planes(job, plate, plan.layers.size());
    return plan;
}

namespace {

/// Returns the layers of all parts with their gaps closed, and appends the joins.
std::vector<Layer> without_gaps(std::span<const Layer> parts, double within_mm, std::vector<GapJoin>& joins) {
    std::vector<Layer> closed;
    for (const Layer& layer : parts) {
        ClosedGaps result = close_gaps(layer, within_mm);
        joins.insert(joins.end(), result.joins.begin(), result.joins.end());
        closed.push_back(std::move(result.layer));
    }
    return closed;
}

/// The planes that are sliced, and the range of them that is written. The other planes are neighbours that
/// skins depend on.
struct Planes {
    Plan plan;
    PlaneRange written;
};

Planes planes_of(const FileJob& job, const Plate& plate, const Execution& execution) {
    Planes planes{plan_of(job, plate, execution), {}};
    planes.written = {0, static_cast<std::uint32_t>(planes.plan.layers.size())};
    const PlaneSelection& only = job.layering.only;
    if (!job.scan || (!only.z_range && !only.index_range))
        return planes;
    const std::uint64_t first = planes.plan.layers.front().index;
    const std::uint64_t begin = first - std::min<std::uint64_t>(first, job.scan->downskin.layers);
    FileJob wider = job;
    wider.layering.only = {
        .index_range = {{begin, planes.plan.layers.back().index + 1 + job.scan->upskin.layers}}};
    planes.plan = plan_of(wider, plate, execution);
    const auto before = static_cast<std::uint32_t>(first - begin);
    planes.written = {before, before + planes.written.end};
    assert(planes.plan.layers[before].index == first && planes.written.end <= planes.plan.layers.size());
    return planes;
}

/// Returns a range extended by the neighbours that skins depend on, in a plan of `planned` planes.
PlaneRange with_neighbours(const FileJob& job, PlaneRange planes, std::size_t planned) {
    const auto last = static_cast<std::uint32_t>(planned);
    if (planes.size() == 0)
        return {last, last};
    if (!job.scan)
        return planes;
    return widened(planes, job.scan->downskin.layers, job.scan->upskin.layers, {0, last});
}

/// Returns a bound of the layers of a body in this box after the steps. It is not tight: only sharp corners
/// move farther than the sides, and open chains do not move.
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

/// Inspects every shape. With `keep_welded` the shapes stay welded, so that an engine that welds need not do
/// it again. Returns the sums over all parts, each of which is a solid of its own.
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
    double seconds = 0; ///< without the volume
};

Prepared prepare(Plate& plate, const FileJob& job, const Engine& engine, const Execution& execution) {
    Prepared done;
    const Stopwatch welding;
    const bool inspected = job.inspect || job.strict;
    const bool indexed = std::any_of(plate.shapes.begin(), plate.shapes.end(),
                                     [](const PlateShape& shape) { return shape.mesh.indexed() != nullptr; });
    // Slicing would join them, too; doing it here frees the mesh as it was read.
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
        for (std::size_t i = 0; i < plate.shapes.size(); ++i) {
            PlateShape& shape = plate.shapes[i];
            FileResult::MeshRepair& repair = done.repairs.emplace_back();
            repair.file = shape.input;
            shape.mesh = repaired(shape.mesh, job.repair, repair.repairs, execution);
            if (shape.mesh.empty())
                throw Error(ErrorKind::input, fmt::format("{}: nothing of the mesh is left after its repair",
                                                          name_of_shape(plate, i)));
        }
        done.seconds += repairing.seconds();
    }
    return done;
}

/// Divides the planes that are written into ranges of equal work. Returns the range of each process, empty
/// ones at the end if there are more processes than planes; or the range of the shard.
std::vector<PlaneRange> divide(const FileJob& job, const Planes& planes, Feed& feed, Communicator& processes,
                               const Execution& execution) {
    const PlaneRange written = planes.written;
    if (job.shard && (job.shard->number < 1 || job.shard->number > job.shard->count))
        throw Error(ErrorKind::usage, fmt::format("there is no shard {} of {}; they are counted from 1",
                                                  job.shard->number, job.shard->count));
    if (!job.shard && processes.size() == 1 && feed.meshes() != nullptr)
        return {written};
    const RangeSurvey survey(part_of(feed.count(planes.plan, execution), written));
    std::vector<PlaneRange> division;
    if (job.shard)
        division = {divide_evenly(survey, job.shard->count)[job.shard->number - 1]};
    else
        division = divide_evenly(
            survey, static_cast<std::uint32_t>(std::min<std::size_t>(processes.size(), written.size())));
    for (PlaneRange& part : division)
        part = {written.begin + part.begin, written.begin + part.end};
    if (!job.shard)
        division.resize(processes.size(), {written.end, written.end});
    return division;
}

/// Takes the layers of one plane from the engine through all steps to the output.
class LayerProcessor {
  public:
    /// `sliced` is the range of planes of the plan that arrive; those in `mine` are written. `supports` is
    /// true for each part that is a support.
    LayerProcessor(const FileJob& job, const Plate& plate, const Plan& plan, PlaneRange sliced,
                   PlaneRange mine, const std::vector<bool>& supports, LayerTotals& totals, JobOutput& output,
                   const LayerLimits& limits)
        : job_(job), plate_(plate), limits_(limits), supports_(supports), memories_(supports.size()),
          first_index_(plan.layers.front().index), mine_(mine), totals_(totals), output_(output),
          window_(
              sliced, mine, job.scan ? job.scan->downskin.layers : 0, job.scan ? job.scan->upskin.layers : 0,
              [this](std::size_t part, const Layer& layer) {
                  return naming(names_[part], [&] { return ScanLayer(layer, {}, limits_); });
              },
              [this](const PlaneLayers& plane) { return output_.prepare(vectors_of(plane)); }) {
        for (const PlatePart& part : plate.parts)
            names_.push_back(name_of(plate, part));
    }

    /// Like PlateSink.
    [[nodiscard]] std::function<void()> operator()(std::span<const Layer> parts) {
        std::vector<Layer> closed;
        std::vector<GapJoin> joins;
        if (job_.repair.close_gaps_mm &&
            std::any_of(parts.begin(), parts.end(), std::mem_fn(&Layer::open_chains))) {
            closed = without_gaps(parts, *job_.repair.close_gaps_mm, joins);
            parts = closed;
        }
        const std::vector<InvertedRings> inverted = inverted_of(parts);
        std::vector<Layer> made;
        LayerChanges changes;
        std::vector<Layer> filled; // parts and negative volumes
        std::vector<Layer> material;
        LayerSteps steps = job_.steps;
        if (!plate_.negatives.empty()) {
            const Stopwatch stepping;
            LayerSteps first; // fills each body where it has material
            first.fill = std::exchange(steps.fill, FillRule::none);
            filled = take_steps_on_plane(first, parts, changes, limits_, names_);
            material = without_negatives(filled, plate_, limits_);
            parts = material;
            count(stepping, step_nanoseconds_);
        }
        if (steps.any()) {
            const Stopwatch stepping;
            LayerChanges more;
            made = take_steps_on_plane(steps, parts, more, limits_, names_);
            changes += more;
            changes.changed_layers = std::min<std::uint64_t>(1, changes.changed_layers);
            count(stepping, step_nanoseconds_);
            parts = made;
        }
        const auto plane = static_cast<std::uint32_t>(parts.front().index - first_index_);
        if (mine_.begin <= plane && plane < mine_.end)
            totals_.add(parts, std::move(joins), changes, inverted, filled);
        std::function<void()> write = job_.scan ? window_(plane, parts) : output_.prepare(parts);
        if (!write)
            return {};
        return [this, write = std::move(write)] {
            const Stopwatch writing;
            write();
            write_seconds_ += writing.seconds();
        };
    }

    /// Sum over all threads.
    [[nodiscard]] double step_seconds() const noexcept {
        return 1e-9 * static_cast<double>(step_nanoseconds_);
    }
    [[nodiscard]] double scan_seconds() const noexcept {
        return 1e-9 * static_cast<double>(scan_nanoseconds_);
    }
    [[nodiscard]] double write_seconds() const noexcept { return write_seconds_; } ///< of the part in order

  private:
    static void count(const Stopwatch& watch, std::atomic<std::uint64_t>& nanoseconds) {
        nanoseconds.fetch_add(static_cast<std::uint64_t>(1e9 * watch.seconds()), std::memory_order_relaxed);
    }

    /// Returns the inverted rings of each part before the steps, which remove rings that bound no material.
    /// Empty if a fill rule defines the material, or if scan_plane finds them. Crossings are searched only if
    /// the steps would lose the rings that they reveal.
    [[nodiscard]] std::vector<InvertedRings> inverted_of(std::span<const Layer> parts) const {
        std::vector<InvertedRings> inverted;
        const bool as_cut = !job_.steps.any() && plate_.negatives.empty();
        if ((job_.scan && as_cut) || job_.steps.fill != FillRule::none)
            return inverted;
        const bool loses = job_.scan || job_.steps.offset_mm != 0 || !plate_.negatives.empty();
        const InversionSearch search = loses ? InversionSearch::full : InversionSearch::quick;
        for (std::size_t i = 0; i < parts.size(); ++i)
            inverted.push_back(naming(i < names_.size() ? names_[i] : std::string(),
                                      [&] { return inverted_rings(parts[i], {}, search, limits_); }));
        return inverted;
    }

    ScanVectors vectors_of(const PlaneLayers& plane) {
        const Stopwatch scanning;
        PlaneVectors vectors = scan_plane(plane, supports_, names_, *job_.scan, memories_, limits_);
        count(scanning, scan_nanoseconds_);
        if (job_.steps.any() || !plate_.negatives.empty())
            vectors.inverted.clear(); // counted by inverted_of
        totals_.add(plane.parts.front().layer().index, vectors);
        return std::move(vectors.vectors);
    }

    const FileJob& job_;
    const Plate& plate_;
    LayerLimits limits_;
    const std::vector<bool>& supports_;
    std::vector<std::string> names_;   ///< of the parts, for errors
    std::vector<InsetCache> memories_; ///< one for each part
    std::uint64_t first_index_;
    PlaneRange mine_;
    LayerTotals& totals_;
    JobOutput& output_;
    LayerWindow window_;
    std::atomic<std::uint64_t> step_nanoseconds_{0};
    std::atomic<std::uint64_t> scan_nanoseconds_{0};
    double write_seconds_ = 0;
};

/// Returns an execution that reports the planes of a range as a part of all planes. It reports no other
/// stage, since stages must not repeat for each range.
Execution in_range(PlaneRange range, PlaneRange mine, const Execution& execution) {
    Execution run = execution;
    if (execution.progress)
        run.progress = [&execution, range, mine](const Progress& progress) {
            if (progress.stage == Stage::slice && progress.total != 0)
                execution.progress({Stage::slice,
                                    range.begin - mine.begin + progress.done * range.size() / progress.total,
                                    mine.size()});
        };
    return run;
}

/// Takes the longest times of all processes, since they work at the same time, and the sums of counts.
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
              &FileResult::Seconds::scan, &FileResult::Seconds::write})
            seconds.*stage = std::max(seconds.*stage, other.*stage);
        for (double SliceReport::*time :
             {&SliceReport::weld_seconds, &SliceReport::link_seconds, &SliceReport::slice_seconds})
            report.*time = std::max(report.*time, from.get<double>());
        if (const auto matching = from.get<MatchingCounts>(); report.matching)
            *report.matching += matching;
    }
}

/// `feed_of` opens the triangles; it is called once the job has been checked.
FileResult slice_job(const FileJob& job, Communicator& processes, const Execution& execution,
                     const std::function<Feed(const Engine& engine)>& feed_of) {
    const Stopwatch total;
    FileResult result;

    // Errors of the job itself are found before a large file is read.
    check_inputs(job.inputs);
    if (processes.size() > 1 && job.shard)
        throw Error(ErrorKind::usage,
                    "processes share out all layers among themselves, not those of a shard");
    if (processes.size() > 1 && !job.report.path.empty())
        throw Error(ErrorKind::usage,
                    "no process has all layers for a page of the run; write a slice file, and "
                    "let lamella view make a page of it");
    const Engine& engine = job.engine.empty() ? engines().front() : lamella::engine(job.engine);
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
    result.engine = engine.name;
    result.threads = thread_count(execution);

    const Stopwatch reading;
    Feed feed = feed_of(engine);
    result.seconds.read = reading.seconds();
    const Plate& plate = feed.plate();

    Planes planes;
    Prepared prepared;
    in_agreement(processes, [&] {
        check_heights(plate);
        if (job.build_volume)
            check_build_volume(plate, *job.build_volume);
        planes = planes_of(job, plate, execution);
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
    const PlaneRange sliced_here = sliced[processes.process()];

    JobOutput output(job, file_info(job, plate, plan, all), {mine.begin - all.begin, mine.end - all.begin},
                     processes, feed.memory().of_output());
    std::vector<bool> supports;
    std::vector<std::uint32_t> files;
    for (const PlatePart& part : plate.parts) {
        supports.push_back(part.support);
        files.push_back(static_cast<std::uint32_t>(plate.shapes[part.shape].input));
    }
    for (const PlateNegative& negative : plate.negatives)
        files.push_back(static_cast<std::uint32_t>(plate.shapes[negative.shape].input));
    LayerTotals totals(job, std::span(plan.layers).subspan(mine.begin, mine.size()), supports, files);
    const LayerLimits limits =
        layer_limits(execution, feed.memory().limit, feed.memory().asked ? result.threads : 1);
    LayerProcessor way(job, plate, plan, sliced_here, mine, supports, totals, output, limits);
    ShapeVisitor visitor;
    if (feed.meshes() != nullptr) {
        feed.begin_near_faces(plan);
        if (feed.may_have_near_faces())
            visitor = [&feed](std::size_t shape, const Mesh& mesh, std::uint64_t begin, std::uint64_t end) {
                feed.show_near_faces(shape, mesh, begin, end);
            };
    }
    double slice_seconds = 0; // without waiting for other processes
    std::uint64_t ranges_of_all = 0;
    {
        const std::vector<PlaneRange> ranges = feed.bring(plan, sliced, execution);
        ranges_of_all = ranges.size();
        in_agreement(processes, [&] {
            const Stopwatch slicing;
            for (std::size_t s = 0; s < ranges.size(); ++s)
                result.report +=
                    slice_plate_to(std::ref(way), feed.take(s, execution), part_of(plan, ranges[s]),
                                   ranges.size() > 1 || feed.meshes() == nullptr
                                       ? in_range(ranges[s], sliced_here, execution)
                                       : execution,
                                   engine, feed.memory().points_in_flight(result.threads),
                                   job.scan ? SinkCost::expanding : SinkCost::proportional, visitor);
            if (visitor && ranges.empty()) // no planes here, but near faces are counted for all processes
                for (std::size_t shape = 0; shape < plate.shapes.size(); ++shape)
                    visitor(shape, plate.shapes[shape].mesh, 0, plate.shapes[shape].mesh.size());
            slice_seconds = slicing.seconds();
        });
    }
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
    processes.sum(std::span(&ranges_of_all, 1));
    result.ranges = feed.in_ranges() ? ranges_of_all : 0;
    if (feed.meshes() == nullptr)
        result.seconds.read = feed.figures().read_seconds;
    result.seconds.weld = prepared.seconds;
    result.seconds.polygon = way.step_seconds();
    result.seconds.scan = way.scan_seconds();
    result.seconds.write = way.write_seconds();

    ProcessFigures figures = feed.figures();
    figures.planes = mine.size();
    figures.points = totals.points();
    figures.slice_seconds = slice_seconds;
    gather(processes, result.seconds, result.report);
    totals.gather(processes);
    totals.store_in(result);
    result.unreached_by_file.resize(result.files.size());
    result.near_faces.resize(result.files.size());
    for (const Feed::NearPlane& near : feed.near_faces())
        if (all.begin <= near.plane && near.plane < all.end)
            result.near_faces[near.file].add(plan.layers[near.plane].z, near.area_mm2, near.farthest_mm);
    for (std::size_t file = 0; file < result.files.size() && job.strict; ++file)
        if (result.near_faces[file].layers > 0)
            throw Error(ErrorKind::defect, fmt::format("{}: {}", result.files[file].path,
                                                       result.near_faces[file].text(result.report.layers)));
    if (job.strict)
        for (std::size_t file = 0; file < result.doubts.size(); ++file)
            if (const std::vector<std::string> doubts = result.doubts[file].texts(); !doubts.empty())
                throw Error(ErrorKind::defect, fmt::format("{}: {}", job.inputs[file].path, doubts.front()));
    // Other shards may have contours.
    if (job.strict && !job.shard && result.changes && result.changes->changed_layers > 0 &&
        result.report.contours == 0)
        throw Error(ErrorKind::defect, fmt::format("{}: nothing is left of any of {} layers after the steps",
                                                   name_of(job.inputs), result.report.layers));
    for (std::size_t file = 0; file < result.files.size() && job.strict; ++file)
        if (result.unreached_by_file[file].layers > 0)
            throw Error(ErrorKind::defect, fmt::format("{}: {}", result.files[file].path,
                                                       result.unreached_by_file[file].text()));

    const Stopwatch writing;
    JobOutput::Written file = output.finish_file();
    result.format = std::move(file.format);
    result.bytes = file.bytes;
    result.warnings = std::move(file.warnings);
    figures.write_seconds = writing.seconds();
    result.seconds.write += figures.write_seconds;
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
            throw Error(error.kind(), fmt::format("{}; {} is complete", error.what(), job.output));
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
