#include "pipeline/plate_slicing.hpp"

#include "core/executor.hpp"
#include "slicing/shrunken_contours.hpp"
#include "slicing/slabs.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lamella {
namespace {

/// Progress of several runs of one kind as that of one.
class JointProgress {
  public:
    JointProgress(const Plate& plate, const Plan& plan, std::size_t windows) {
        for (const PlateShape& shape : plate.shapes)
            triangles_ += shape.mesh.size() * windows;
        planes_ = plate.shapes.size() * plan.layers.size();
    }

    /// How the next run is to be executed.
    [[nodiscard]] Execution next(const Execution& execution) {
        for (Count& count : counts_)
            count = {count.before + count.total, 0};
        Execution run = execution;
        if (execution.progress)
            run.progress = [this, &execution](const Progress& progress) {
                Count& count = counts_.at(static_cast<std::size_t>(progress.stage));
                count.total = progress.total;
                const std::uint64_t all = progress.stage == Stage::slice ? planes_ : triangles_;
                const std::uint64_t done = count.before + progress.done;
                execution.progress({progress.stage, done, std::max(all, done)});
            };
        return run;
    }

  private:
    struct Count {
        std::uint64_t before = 0; ///< of the runs that are over
        std::uint64_t total = 0;  ///< of this one
    };
    std::array<Count, 6> counts_;
    std::uint64_t triangles_ = 0;
    std::uint64_t planes_ = 0;
};

Layer moved(const Layer& layer, double dx, double dy) {
    if (dx == 0 && dy == 0)
        return layer;
    // Rounding can make neighbours equal, and then another point the smallest: as where layers are cut, these
    // go, and the normal form is made anew.
    LayerBuilder builder;
    std::vector<Point2> contour;
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        contour.clear();
        for (const Point2& p : layer.contour(i))
            contour.push_back({p.x + dx, p.y + dy});
        add_contour(builder, contour, layer.closed(i));
    }
    return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
}

/// Runs of planes on which all shapes together have no more points than that, where a single plane has not.
/// One run where they need not be counted to know.
std::vector<PlaneRange> windows(const Plate& plate, const Plan& plan, std::uint64_t most_points,
                                const Execution& execution) {
    const auto planes = static_cast<std::uint32_t>(plan.layers.size());
    std::uint64_t triangles = 0;
    for (const PlateShape& shape : plate.shapes)
        triangles += shape.mesh.size();
    if (triangles <= most_points / planes)
        return {{0, planes}};
    PlaneCounts counts(planes);
    for (const PlateShape& shape : plate.shapes)
        counts.add(count_planes(shape.mesh, plan, execution));
    return divide_by_points(SlabSurvey(counts), most_points);
}

/// Without the progress of slicing.
Execution without_slicing(const Execution& execution) {
    Execution run = execution;
    if (execution.progress)
        run.progress = [&execution](const Progress& progress) {
            if (progress.stage != Stage::slice)
                execution.progress(progress);
        };
    return run;
}

/// The layers of all parts on a run of planes, formatted in parallel, written in order. Empties the stacks.
void emit(const PlateSink& sink, const Plate& plate, std::vector<LayerStack>& stacks, Executor& executor,
          ProgressMeter* progress) {
    const std::size_t planes = stacks.front().size();
    const std::size_t at_once = std::size_t{4} * executor.workers(); // so that all workers have some
    std::vector<std::function<void()>> actions(at_once);
    for (std::size_t first = 0; first < planes; first += at_once) {
        const std::size_t count = std::min(at_once, planes - first);
        executor.for_chunks(count, 1, [&](std::size_t i, std::size_t, unsigned) {
            std::vector<Layer> parts;
            for (const PlatePart& part : plate.parts)
                parts.push_back(moved(stacks[part.shape][first + i], part.dx, part.dy));
            actions[i] = sink(parts);
        });
        executor.check_cancelled();
        for (std::size_t i = 0; i < count; ++i)
            if (actions[i])
                actions[i]();
        for (LayerStack& stack : stacks) // what is written is not needed any more
            for (std::size_t i = first; i < first + count; ++i)
                stack[i] = {};
        if (progress != nullptr)
            progress->add(count);
    }
}

SliceReport slice_parts(const PlateSink& sink, const Plate& plate, const Plan& plan,
                        const Execution& execution, const Engine& engine, std::uint64_t points_in_flight,
                        SinkYield yield) {
    SliceReport report;
    // Each window takes a look at all triangles: they are few, and large. Engines that weld would do so anew.
    constexpr std::uint64_t share = 2;
    const auto all = static_cast<std::uint32_t>(plan.layers.size());
    const std::vector<PlaneRange> runs = engine.welds || points_in_flight == 0
                                             ? std::vector<PlaneRange>{{0, all}}
                                             : windows(plate, plan, share * points_in_flight, execution);
    JointProgress progress(plate, plan, runs.size());
    // Where the sink makes much of layers, that is what takes long.
    const bool sink_counts = yield == SinkYield::much_more;
    const Execution slicing = sink_counts ? without_slicing(execution) : execution;
    std::optional<ProgressMeter> emitted;
    Executor executor(execution);
    for (const PlaneRange& run : runs) {
        std::vector<LayerStack> stacks;
        for (const PlateShape& shape : plate.shapes) {
            SliceReport ours;
            stacks.push_back(slice(shape.mesh, part_of(plan, run), progress.next(slicing), &ours, engine));
            report += ours;
        }
        if (sink_counts && !emitted)
            emitted.emplace(execution, Stage::slice, all);
        emit(sink, plate, stacks, executor, emitted ? &*emitted : nullptr);
    }
    if (emitted)
        emitted->finish();
    return report;
}

} // namespace

SliceReport slice_plate_to(const PlateSink& sink, const Plate& plate, const Plan& plan,
                           const Execution& execution, const Engine& engine, std::uint64_t points_in_flight,
                           SinkYield yield) {
    if (plate.parts.size() > 1 || yield == SinkYield::much_more)
        return slice_parts(sink, plate, plan, execution, engine, points_in_flight, yield);
    const LayerSink single = [&](Layer&& layer) {
        return sink(std::span<const Layer>(&layer, 1));
    };
    SliceReport report;
    slice_to(single, plate.shapes.front().mesh, plan, execution, &report, engine, points_in_flight);
    return report;
}

} // namespace lamella
