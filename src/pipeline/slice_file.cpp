#include "lamella/pipeline/slice_file.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "pipeline/job_memory.hpp"
#include "pipeline/layer_source.hpp"
#include "pipeline/plate_source.hpp"
#include "pipeline/slicing_steps.hpp"
#include "pipeline/stopwatch.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <utility>

namespace lamella {
namespace {

/// Parts are called by the name of their file.
const PlateFile& file_of(const Plate& plate, const PlatePart& part) {
    return plate.files[plate.shapes[part.shape].input];
}

void check_heights(const Plate& plate) {
    for (const PlatePart& part : plate.parts) {
        if (part.box.min.z != part.box.max.z)
            continue;
        const PlateFile& file = file_of(plate, part);
        // What its reading met may be the cause.
        const std::string cause = file.warnings.empty() ? "" : fmt::format(" ({})", file.warnings.front());
        throw Error(ErrorKind::input,
                    fmt::format("{}: the mesh is flat: all of it lies at z = {:.6g}, so there is nothing to "
                                "slice; rotate it or choose another direction{}",
                                file.path, part.box.min.z, cause));
    }
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

/// A layer height that is a thousand times too small asks for more layers than memory has notes for.
void check_count(const FileJob& job, double height) {
    double count = height / job.layers.layer_height;
    if (const auto& range = job.layers.z_range)
        count = std::min(count, (range->second - range->first) / job.layers.layer_height);
    if (const auto& range = job.layers.index_range)
        count = std::min(count, static_cast<double>(range->second - range->first));
    constexpr double few = 1e5; // take nothing to speak of
    constexpr double most = std::numeric_limits<std::int32_t>::max();
    if (!(count > few && count <= most))
        return; // plan_uniform knows what to say of more
    const JobMemory memory(job);
    const std::uint64_t bytes = JobMemory::overhead(1, static_cast<std::uint64_t>(count));
    constexpr double giga = 1e9;
    if (bytes > memory.limit)
        throw Error(
            ErrorKind::limit,
            fmt::format(
                "a layer height of {:.6g} mm makes {:.6g} layers of this part ({:.6g} mm high), which take "
                "{:.3g} GB of memory, above the {:.3g} GB {}; choose a larger one, or fewer layers",
                job.layers.layer_height, count, height, static_cast<double>(bytes) / giga,
                static_cast<double>(memory.limit) / giga,
                memory.asked ? "of --max-memory" : "that may be taken here"));
}

Plan uniform_plan(const FileJob& job, const Box3& box) {
    const double height = box.max.z - box.min.z;
    if (job.layers.layer_height > height)
        throw Error(
            ErrorKind::usage,
            fmt::format("the layer height of {:.6g} mm is above the part's height of {:.6g} mm; choose "
                        "a smaller one, or check the unit of the file",
                        job.layers.layer_height, height));
    check_count(job, height);
    return plan_uniform(box.min.z, box.max.z, job.layers);
}

/// `adaptive` makes the plan of layers of varying height.
Plan plan_within(const Box3& box, const FileJob& job, Plan listed,
                 const std::function<Plan(const AdaptiveLayers&)>& adaptive) {
    if (!job.z.empty())
        return selected(job, std::move(listed), box);
    if (job.adaptive)
        return selected(job, adaptive(*job.adaptive), box);
    if (!job.heights.empty())
        return selected(
            job,
            plan_by_ranges(box.min.z, box.max.z, job.heights, job.layers.layer_height, job.layers.slice_at),
            box);
    return uniform_plan(job, box);
}

} // namespace

Plan plan_of(const FileJob& job, LayerSource& source, Plan listed, const Execution& execution) {
    return plan_within(source.plate().box, job, std::move(listed),
                       [&](const AdaptiveLayers& layers) { return source.adaptive_plan(layers, execution); });
}

Plan plan_of(const FileJob& job, const Plate& plate, const Execution& execution) {
    check_heights(plate);
    Plan listed;
    if (!job.z.empty())
        listed = plan_listed(job.z, job.layers.slice_at);
    return plan_within(plate.box, job, std::move(listed), [&](const AdaptiveLayers& layers) {
        return plan_adaptive(joined(plate, execution), layers, execution);
    });
}

namespace {

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

PlaneRange planes_of(const Shard& shard, LayerSource& source, const Plan& plan, const Execution& execution) {
    if (shard.number < 1 || shard.number > shard.count)
        throw Error(ErrorKind::usage, fmt::format("there is no shard {} of {}; they are counted from 1",
                                                  shard.number, shard.count));
    return divide_evenly(SlabSurvey(source.counts(plan, execution)), shard.count)[shard.number - 1];
}

} // namespace

LayerFileInfo file_info(const Plate& plate, const Plan& plan) {
    LayerFileInfo info{
        .box = plate.box, .layers = plan.layers.size(), .bottom = plan.layers.front().bottom, .parts = {}};
    for (const PlatePart& part : plate.parts)
        info.parts.push_back({part.label, part.box});
    return info;
}

void describe_parts(const FileJob& job, const LayerSource& source, FileResult& result) {
    const Plate& plate = source.plate();
    check_heights(plate);
    if (job.build_volume)
        check_build_volume(plate, *job.build_volume);
    result.files = plate.files;
    result.box = plate.box;
    for (const PlatePart& part : plate.parts) {
        result.parts.push_back(
            {.label = part.label, .triangles = source.triangles(part.shape), .box = part.box});
        result.triangles += result.parts.back().triangles;
    }
}

void slice_layers(const FileJob& job, LayerSource& source, const Plan& plan,
                  std::span<LayerWriter* const> writers, FileResult& result, const Engine& with,
                  const Execution& execution) {
    Gatherer gatherer(plan, source.plate().parts.size(), job);
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
        std::vector<std::function<void()>> writes;
        for (LayerWriter* const writer : writers)
            writes.push_back(writer->prepare(parts));
        if (writes.empty())
            return {};
        return [&result, writes = std::move(writes)] {
            const Stopwatch writing;
            for (const std::function<void()>& write : writes)
                write();
            result.seconds.write += writing.seconds();
        };
    };
    source.slice_to(sink, plan, execution, result, with);
    gatherer.finish(plan, result);
}

void check_closed(const FileJob& job, const FileResult& result) {
    if (job.strict && result.report.open_chains > 0)
        throw Error(ErrorKind::defect,
                    fmt::format("{}: {} contours do not close, the lowest at z = {:.6g} mm",
                                job.inputs.front().path, result.report.open_chains, result.open.first_z));
}

namespace {

void finish(LayerWriter& writer, FileResult& result) {
    const Stopwatch writing;
    writer.finish();
    result.seconds.write += writing.seconds();
    result.bytes = writer.bytes();
    result.warnings = writer.warnings();
}

void finish(LayerPageWriter& page, const FileReport& report, FileResult& result) {
    if (report.notes)
        page.tell(report.notes(result));
    page.finish();
    result.report_warnings = page.warnings();
}

/// `open` gives the source of the layers, once the wishes are known to be possible.
FileResult slice_source(const FileJob& job, const Execution& execution,
                        const std::function<std::unique_ptr<LayerSource>(const Engine& with)>& open) {
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
    const std::unique_ptr<LayerSource> source = open(with);
    result.seconds.read = reading.seconds();
    describe_parts(job, *source, result);
    plan = plan_of(job, *source, std::move(plan), execution);
    result.planned_layers = plan.layers.size();
    result.shard = {0, static_cast<std::uint32_t>(plan.layers.size())};
    if (job.shard) {
        result.shard = planes_of(*job.shard, *source, plan, execution);
        plan = part_of(plan, result.shard);
    }
    result.bottom = plan.layers.front().bottom;
    result.top = plan.layers.back().top;
    source->prepare(job, with, result, execution);

    std::vector<LayerWriter*> writers;
    std::unique_ptr<LayerWriter> writer;
    if (format != nullptr) {
        writer = open_layer_writer(job.output, *format, file_info(source->plate(), plan), job.write);
        writers.push_back(writer.get());
        result.format = format->name;
    }
    std::unique_ptr<LayerPageWriter> report;
    if (!job.report.path.empty()) {
        report = open_layer_page(job.report.path, file_info(source->plate(), plan), job.report.page);
        writers.push_back(report.get());
    }
    slice_layers(job, *source, plan, writers, result, with, execution);
    check_closed(job, result);
    if (writer != nullptr)
        finish(*writer, result);
    result.seconds.weld += result.report.weld_seconds;
    result.seconds.link = result.report.link_seconds;
    result.seconds.slice = result.report.slice_seconds;
    if (report != nullptr)
        finish(*report, job.report, result);
    result.seconds.total = total.seconds();
    return result;
}

} // namespace

FileResult slice_file(const FileJob& job, const Execution& execution) {
    return slice_source(job, execution,
                        [&](const Engine& with) { return open_layer_source(job, with, execution); });
}

FileResult slice_file(const FileJob& job, Plate plate, const Execution& execution) {
    return slice_source(job, execution, [&](const Engine&) {
        return plate_source(std::move(plate), JobMemory(job), execution);
    });
}

} // namespace lamella
