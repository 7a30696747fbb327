#include "jobs/plate_slicing.hpp"

#include "lamella/polygon/fill.hpp"
#include "lamella/slicing/slicer.hpp"

#include "contour/box2.hpp"
#include "core/executor.hpp"
#include "core/ordered_stage.hpp"
#include "core/progress.hpp"
#include "core/stopwatch.hpp"
#include "polygon/subtract.hpp"
#include "slicing/layer_counter.hpp"
#include "slicing/plane_ranges.hpp"
#include "slicing/planned_source.hpp"
#include "slicing/shrunken_contours.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lamella {
namespace {

/// Reports the progress of several runs of the slicer, and of what becomes of their layers, as one. The unit
/// of slicing is a layer: of a shape when it is sliced, and of each body when it is emitted.
class JointProgress {
  public:
    void expect(std::uint64_t triangles, std::uint64_t planes) {
        triangles_ += triangles;
        layers_ += planes;
    }
    void expect_emission(std::uint64_t planes, std::uint64_t bodies) {
        layers_ += planes * bodies;
        bodies_ = bodies;
    }

    /// Returns the execution of the next run.
    [[nodiscard]] Execution next(const Execution& execution) {
        for (Count& count : counts_)
            count = {count.before + count.total, 0};
        return with_progress(execution, [this](const Progress& progress) {
            Count& count = counts_.at(static_cast<std::size_t>(progress.stage));
            count.total = progress.total;
            const bool of_layers = progress.stage == Stage::slice;
            const std::uint64_t all = of_layers ? layers_ : triangles_;
            const std::uint64_t done = count.before + progress.done + (of_layers ? emitted_ : 0);
            return std::optional(Progress{progress.stage, done, std::max(all, done)});
        });
    }
    /// Returns the execution of the meter of all emitted planes.
    [[nodiscard]] Execution emission(const Execution& execution) {
        return with_progress(execution, [this](const Progress& progress) {
            emitted_ = progress.done * bodies_;
            const Count& sliced = counts_.at(static_cast<std::size_t>(Stage::slice));
            const std::uint64_t done = sliced.before + sliced.total + emitted_;
            return std::optional(Progress{Stage::slice, done, std::max(layers_, done)});
        });
    }

  private:
    struct Count {
        std::uint64_t before = 0; ///< work of the completed runs
        std::uint64_t total = 0;  ///< work of this run
    };
    std::array<Count, 6> counts_;
    std::uint64_t triangles_ = 0;
    std::uint64_t layers_ = 0;
    std::uint64_t bodies_ = 0;
    std::uint64_t emitted_ = 0;
};

Layer moved(const Layer& layer, double dx, double dy) {
    if (dx == 0 && dy == 0)
        return layer;
    // Rounding can make neighbours equal, and change which point is the smallest. As in slicing, equal
    // neighbours are removed, and the normal form is restored.
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

LayerSink single(const PlateSink& sink) {
    return {.prepare = [&sink](Layer&& layer) {
        return sink.prepare(std::move(layer));
    }};
}

template <class Visit>
void for_bodies(const Plate& plate, const Visit& visit) {
    for (const PlatePart& part : plate.parts)
        visit(part);
    for (const PlateNegative& negative : plate.negatives)
        visit(negative);
}

/// Returns for each shape the planes on which it can have contours. These are the planes between its lowest
/// and its highest point, extended by the snap distance.
std::vector<PlaneRange> planes_of_shapes(const Plate& plate, const Plan& plan) {
    const auto planes_where = [&plan](auto&& holds) {
        return static_cast<std::uint32_t>(
            std::partition_point(plan.layers.begin(), plan.layers.end(), holds) - plan.layers.begin());
    };
    std::vector<PlaneRange> planes(plate.shapes.size());
    for_bodies(plate, [&](const auto& body) {
        if (!body.box.empty())
            planes[body.shape] = {planes_where([&](const PlannedLayer& layer) {
                                      return layer.z + plan.snap_mm < body.box.min.z;
                                  }),
                                  planes_where([&](const PlannedLayer& layer) {
                                      return layer.z - plan.snap_mm <= body.box.max.z;
                                  })};
    });
    return planes;
}

/// Returns the intersection of two ranges, which may be empty.
PlaneRange common(PlaneRange a, PlaneRange b) {
    const std::uint32_t begin = std::max(a.begin, b.begin);
    return {begin, std::max(begin, std::min(a.end, b.end))};
}

/// The layers of a shape on the planes where it can have contours.
struct ShapeLayers {
    PlaneRange planes;
    LayerStack layers;
};

/// Returns ranges of planes on which all shapes together have at most this many points, unless a single plane
/// has more. Returns one range if the points need not be counted.
std::vector<PlaneRange> windows(const Plate& plate, const Plan& plan, std::uint64_t most_points,
                                const Execution& execution) {
    const auto planes = static_cast<std::uint32_t>(plan.layers.size());
    std::uint64_t triangles = 0;
    for (const PlateShape& shape : plate.shapes)
        triangles += shape.mesh.size();
    if (planes == 0 || triangles <= most_points / planes)
        return {{0, planes}};
    PlaneCounts counts(planes);
    for (const PlateShape& shape : plate.shapes)
        counts.add(count_planes(shape.mesh, plan, execution));
    return divide_by_points(RangeSurvey(counts), most_points);
}

/// Returns an execution that does not report the progress of slicing.
Execution without_slicing(const Execution& execution) {
    return with_progress(execution, [](const Progress& progress) {
        return progress.stage == Stage::slice ? std::nullopt : std::optional(progress);
    });
}

/// Returns for each plane of a range the first plane that may still be in flight when work on it begins. So
/// at most `most` planes, and at most `most_points` points of all parts (0: any number), are in flight. A
/// single plane may have more points. Each layer adds its own memory, in units of points.
std::vector<std::uint32_t> first_on_the_way(const Plate& plate, PlaneRange run, std::uint32_t most,
                                            std::uint64_t most_points,
                                            const std::vector<ShapeLayers>& shapes) {
    const auto points_on = [&](std::uint32_t plane) {
        std::uint64_t points =
            (plate.parts.size() + plate.negatives.size()) * (sizeof(Layer) / sizeof(Point2));
        for_bodies(plate, [&](const auto& body) {
            if (const auto& [planes, layers] = shapes[body.shape];
                planes.begin <= plane && plane < planes.end)
                points += layers[plane - planes.begin].points.size();
        });
        return points;
    };
    std::vector<std::uint32_t> first(run.size());
    std::vector<std::uint64_t> points(run.size());
    std::uint64_t sum = 0; // of the planes in flight
    std::uint32_t begin = 0;
    for (std::uint32_t i = 0; i < run.size(); ++i) {
        points[i] = points_on(run.begin + i);
        sum += points[i];
        while (begin < i && (i - begin >= most || (most_points != 0 && sum > most_points)))
            sum -= points[begin++];
        first[i] = begin;
    }
    return first;
}

/// Passes the layers of all parts on a range of planes to the sink in parallel, and delivers the results in
/// order. At most `at_once` planes are in flight. Empties the shapes.
void emit(const PlateSink& sink, const Plate& plate, const Plan& plan, PlaneRange run, std::uint32_t at_once,
          std::uint64_t points_in_flight, std::vector<ShapeLayers>& shapes, Executor& executor,
          ProgressMeter& progress) {
    const std::vector<std::uint32_t> first = first_on_the_way(plate, run, at_once, points_in_flight, shapes);
    OrderedStage delivery(executor, progress);
    executor.for_chunks(run.size(), 1, [&](std::size_t i, std::size_t, unsigned) {
        if (!delivery.wait_for(first[i]))
            return;
        const auto plane = static_cast<std::uint32_t>(run.begin + i);
        const PlannedLayer& planned = plan.layers[plane];
        const Layer none{
            .index = planned.index, .z = planned.z, .bottom = planned.bottom, .top = planned.top};
        std::vector<Layer> parts;
        parts.reserve(plate.parts.size() + plate.negatives.size());
        for_bodies(plate, [&](const auto& body) {
            const auto& [planes, layers] = shapes[body.shape];
            const bool has = planes.begin <= plane && plane < planes.end;
            parts.push_back(has ? moved(layers[plane - planes.begin], body.dx, body.dy) : none);
        });
        for (auto& [planes, layers] : shapes) // no other thread reads this plane
            if (planes.begin <= plane && plane < planes.end)
                layers[plane - planes.begin] = {};
        delivery.deliver(static_cast<std::uint32_t>(i), sink.prepare(Plane(std::move(parts))));
    });
    executor.check_cancelled();
}

/// Returns the visitor of one shape; empty if `visitor` is empty.
TriangleVisitor visitor_of(std::size_t shape, const ShapeVisitor& visitor) {
    if (!visitor)
        return {};
    return [&visitor, shape](const Mesh& mesh, std::uint64_t begin, std::uint64_t end) {
        visitor(shape, mesh, begin, end);
    };
}

SliceReport slice_parts(const PlateSink& sink, const Plate& plate, const Plan& plan,
                        const SliceOptions& options, SinkCost cost, const ShapeVisitor& visitor) {
    const Execution& execution = options.execution;
    const std::uint64_t points_in_flight = options.points_in_flight.value_or(0);
    SliceReport report;
    // The slicer visits all triangles for each range, so ranges should be few and large. An engine that welds
    // would weld again for each range, so it gets a single range.
    constexpr std::uint64_t windows_per_limit = 2;
    const auto all = static_cast<std::uint32_t>(plan.layers.size());
    const std::vector<PlaneRange> runs =
        options.engine.welds || points_in_flight == 0
            ? std::vector<PlaneRange>{{0, all}}
            : windows(plate, plan, windows_per_limit * points_in_flight, execution);
    const std::vector<PlaneRange> planes = planes_of_shapes(plate, plan);
    JointProgress progress;
    for (const PlaneRange& run : runs)
        for (std::size_t shape = 0; shape < planes.size(); ++shape)
            if (const PlaneRange its = common(planes[shape], run); its.size() > 0)
                progress.expect(plate.shapes[shape].mesh.size(), its.size());
    // If the sink expands layers, its work takes most of the time, and its progress is reported instead.
    const bool sink_counts = cost == SinkCost::expanding;
    const Execution slicing = sink_counts ? without_slicing(execution) : execution;
    if (!sink_counts)
        progress.expect_emission(all, plate.parts.size() + plate.negatives.size());
    const Execution emission = sink_counts ? execution : progress.emission(execution);
    std::optional<ProgressMeter> emitted;
    std::vector<bool> seen(planes.size(), false);
    Executor executor(execution);
    // With four planes for each thread, threads seldom wait for a plane that takes longer. If the sink
    // expands layers, memory allows only one plane for each thread.
    const std::uint32_t at_once = (sink_counts ? 1 : 4) * executor.workers();
    for (const PlaneRange& run : runs) {
        std::vector<ShapeLayers> shapes(planes.size());
        for (std::size_t shape = 0; shape < planes.size(); ++shape)
            if (const PlaneRange its = common(planes[shape], run); its.size() > 0) {
                shapes[shape].planes = its;
                shapes[shape].layers.reserve(its.size());
                report +=
                    slice_to(appending_to(shapes[shape].layers), plate.shapes[shape].mesh, part_of(plan, its),
                             {.execution = progress.next(slicing),
                              .engine = options.engine,
                              .points_in_flight = 0, // all layers are held
                              .visitor = seen[shape] ? TriangleVisitor() : visitor_of(shape, visitor)});
                seen[shape] = true;
            }
        if (!emitted)
            emitted.emplace(emission, Stage::slice, all);
        const Stopwatch emitting;
        emit(sink, plate, plan, run, at_once, points_in_flight, shapes, executor, *emitted);
        report.slice_seconds += emitting.seconds();
    }
    if (emitted)
        emitted->finish();
    for (std::size_t shape = 0; shape < planes.size() && visitor; ++shape)
        if (const Mesh& mesh = plate.shapes[shape].mesh; !seen[shape])
            visitor(shape, mesh, 0, mesh.size());
    return report;
}

/// Returns the layers of the parts without the negative volumes. A part with negative volumes is united where
/// its own bodies overlap, on all layers, because its area would otherwise count overlaps once on layers that
/// a negative volume touches, and twice on the others. Other layers that no negative volume touches are
/// unchanged, bit for bit. O(points), and what combining takes for each pair whose boxes meet.
std::vector<Layer> without_negatives(std::span<const Layer> layers, std::span<const PlateNegative> negatives,
                                     const LayerLimits& limits) {
    const std::span<const Layer> of_parts = layers.first(layers.size() - negatives.size());
    std::vector<Layer> parts(of_parts.begin(), of_parts.end());
    std::vector<Box2> boxes(layers.size());
    for (std::size_t i = 0; i < layers.size(); ++i)
        if (layers[i].rings > 0)
            boxes[i] = box_of(layers[i].points);
    std::vector<bool> united(parts.size());
    for (const PlateNegative& negative : negatives)
        for (const std::size_t part : negative.parts)
            if (!united[part]) {
                united[part] = true;
                if (Filled filled = fill(parts[part], FillRule::positive, limits); filled.groups_united != 0)
                    parts[part] = std::move(filled.layer);
            }
    for (std::size_t i = 0; i < negatives.size(); ++i) {
        const Layer& negative = layers[parts.size() + i];
        if (negative.rings == 0)
            continue;
        const Box2& box = boxes[parts.size() + i];
        for (const std::size_t part : negatives[i].parts)
            if (parts[part].rings > 0 && boxes[part].meets(box))
                parts[part] = subtract_body(parts[part], negative, limits);
    }
    return parts;
}

} // namespace

PlateMaterial material_of(std::span<const Layer> bodies, std::span<const PlateNegative> negatives,
                          const LayerSteps& steps, const LayerLimits& limits,
                          std::span<const std::string> names) {
    PlateMaterial made;
    LayerSteps later = steps;
    std::span<const Layer> parts = bodies;
    if (!negatives.empty()) {
        LayerSteps first; // fills each body where it has material
        first.fill = std::exchange(later.fill, FillRule::none);
        ChangedPlane filled = take_steps_on_plane(first, bodies, limits, names);
        made.bodies = std::move(filled.parts);
        made.changes = filled.changes;
        made.parts = without_negatives(made.bodies, negatives, limits);
        parts = made.parts;
    }
    if (later.any() || negatives.empty()) {
        ChangedPlane stepped = take_steps_on_plane(later, parts, limits, names);
        made.parts = std::move(stepped.parts);
        made.changes += stepped.changes;
        made.changes.changed_layers = std::min<std::uint64_t>(1, made.changes.changed_layers);
    }
    return made;
}

SliceReport slice_to(const PlateSink& sink, const Plate& plate, const Plan& plan,
                     const SliceOptions& options) {
    constexpr std::uint64_t usual_points = std::uint64_t{1} << 22; // 64 MB
    SliceOptions bounded = options;
    if (!options.points_in_flight && plate.parts.size() + plate.negatives.size() > 1)
        bounded.points_in_flight = usual_points;
    ShapeVisitor visitor;
    if (options.visitor)
        visitor = [&options](std::size_t, const Mesh& mesh, std::uint64_t begin, std::uint64_t end) {
            options.visitor(mesh, begin, end);
        };
    return slice_plate_to(sink, plate, plan, bounded, SinkCost::proportional, visitor);
}

SliceReport slice_to(const LayerSink& sink, const Plate& plate, const Plan& plan,
                     const SliceOptions& options) {
    if (plate.parts.empty())
        return slice_to(sink, Mesh(), plan, options);
    LayerCounter counter(sink);
    const PlateSink of_plate{.prepare = [&](const Plane& bodies) {
        std::vector<Layer> parts = material_of(bodies.polylines, plate.negatives).parts;
        return counter.prepare(parts.size() == 1 ? std::move(parts.front()) : merged(parts));
    }};
    SliceReport report = slice_to(of_plate, plate, plan, options);
    counter.set_counts(report);
    return report;
}

PlaneSource planes_of(const Plate& plate, const Plan& plan, const Execution& execution) {
    PlaneSource source = planned_source(plan);
    std::vector<PlaneSource> shapes;
    for (const PlateShape& shape : plate.shapes)
        shapes.push_back(Slicer(shape.mesh, plan.rule, execution).slice(plan));
    for (const PlatePart& part : plate.parts)
        source.parts.push_back({.label = part.label, .box = part.box, .support = part.support});
    source.make = [shapes = std::move(shapes), parts = plate.parts,
                   negatives = plate.negatives](std::size_t position) {
        std::vector<Layer> bodies;
        const auto add = [&](const auto& body) {
            bodies.push_back(moved(shapes[body.shape].plane(position).polylines.front(), body.dx, body.dy));
        };
        std::for_each(parts.begin(), parts.end(), add);
        std::for_each(negatives.begin(), negatives.end(), add);
        return Plane(material_of(bodies, negatives).parts);
    };
    return source;
}

LayerStack slice(const Plate& plate, const Plan& plan, const SliceOptions& options) {
    LayerStack layers;
    slice_to(appending_to(layers), plate, plan, options);
    return layers;
}

SliceReport slice_plate_to(const PlateSink& sink, const Plate& plate, const Plan& plan,
                           const SliceOptions& options, SinkCost cost, const ShapeVisitor& visitor) {
    assert(!plate.parts.empty());
    check(plan);
    if (plate.parts.size() + plate.negatives.size() > 1 || cost == SinkCost::expanding)
        return slice_parts(sink, plate, plan, options, cost, visitor);
    SliceOptions visited = options;
    visited.visitor = visitor_of(0, visitor);
    return slice_to(single(sink), plate.shapes.front().mesh, plan, visited);
}

} // namespace lamella
