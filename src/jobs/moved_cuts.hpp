#pragma once

// Reference layers of a mesh, cut at the heights that a format may have rounded to a given height.

#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/jobs/verify.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "slicing/plane_ranges.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// Returns the planes at which layers in any order were cut.
inline Plan plan_of(std::span<const Layer> layers, PlaneRule rule, double snap_mm) {
    Plan plan{.layers = {}, .rule = rule, .snap_mm = snap_mm};
    for (const Layer& layer : layers)
        plan.layers.push_back({layer.index, layer.z, std::min(layer.bottom, layer.z),
                               std::max(layer.top, layer.z)}); // a file may round z out of its layer
    std::sort(plan.layers.begin(), plan.layers.end(),
              [](const PlannedLayer& a, const PlannedLayer& b) { return a.z < b.z; });
    const auto same = std::unique(plan.layers.begin(), plan.layers.end(),
                                  [](const PlannedLayer& a, const PlannedLayer& b) { return a.z == b.z; });
    plan.layers.erase(same, plan.layers.end());
    return plan;
}

/// Returns the results of cut(plan) for the plane of each layer. The first result is at the height of the
/// layer. If the format rounds, the next results are at the lowest and the highest height that it may have
/// rounded to this one. Throws the errors of `check` for the plan of the layers.
template <class Cut>
auto at_moved_cuts(std::span<const Layer> layers, const Rounding& rounding, PlaneRule rule, double snap_mm,
                   const Cut& cut) {
    check(plan_of(layers, rule, snap_mm));
    using OfPlane = typename decltype(cut(Plan{}))::value_type;
    std::vector<std::vector<OfPlane>> of_layer(layers.size());
    for (const double direction : {0.0, -1.0, 1.0}) {
        if (direction != 0 && rounding == Rounding{})
            break;
        std::vector<double> z;
        for (const Layer& layer : layers)
            z.push_back(layer.z + direction * moved_cut(layer, rounding));
        std::vector<double> ascending = z;
        std::sort(ascending.begin(), ascending.end());
        ascending.erase(std::unique(ascending.begin(), ascending.end()), ascending.end());
        Plan plan{.layers = {}, .rule = rule, .snap_mm = snap_mm};
        for (const double at : ascending)
            plan.layers.push_back({plan.layers.size(), at, at, at});
        const auto of_plane = cut(plan);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const auto plane = std::lower_bound(ascending.begin(), ascending.end(), z[i]);
            of_layer[i].push_back(of_plane[static_cast<std::size_t>(plane - ascending.begin())]);
        }
    }
    return of_layer;
}

/// Returns consecutive ranges of layers whose sections at all moved cuts take 32 MB together, or that have a
/// single layer: the sections of all layers may take more memory than the layers. The mesh is cut once for
/// each range.
inline std::vector<PlaneRange> ranges_of_sections(std::span<const Layer> layers, const VerifyOptions& options,
                                                  const Execution& execution) {
    constexpr std::uint64_t most_points = (std::uint64_t{32} << 20) / (3 * sizeof(Point2));
    const Plan plan = plan_of(layers, options.rule, options.snap_mm);
    const RangeSurvey survey(count_planes(*options.mesh, plan, execution));
    const auto points_of = [&](const Layer& layer) {
        const auto plane = std::lower_bound(plan.layers.begin(), plan.layers.end(), layer.z,
                                            [](const PlannedLayer& a, double z) { return a.z < z; });
        return survey.points(static_cast<std::uint32_t>(plane - plan.layers.begin()));
    };
    std::vector<PlaneRange> ranges;
    std::uint64_t points = 0;
    for (std::uint32_t i = 0; i < layers.size(); ++i) {
        const std::uint64_t more = points_of(layers[i]);
        if (ranges.empty() || points + more > most_points) {
            ranges.push_back({i, i});
            points = 0;
        }
        ranges.back().end = i + 1;
        points += more;
    }
    return ranges;
}

/// Returns all steps except `simplify`. The last digits of coordinates decide which points `simplify`
/// removes, so its moves are tolerated instead.
inline LayerSteps steps_to_repeat(const VerifyOptions& options, const Execution& execution) {
    LayerSteps steps = options.steps;
    steps.simplify_mm = 0;
    if (steps.bottom.inset_mm != 0)
        steps.bottom.plate_mm = bounding_box(*options.mesh, execution).min.z;
    return steps;
}

/// Returns the mitre limit and, if the format rounds, a lower and a higher limit. At corners of exactly the
/// limiting angle, which is 60 degrees by default, rounding decides whether mitres are truncated.
inline std::vector<double> limits_of_mitres(double limit, const Rounding& rounding) {
    constexpr double spread = 0.01;
    return rounding == Rounding{}
               ? std::vector{limit}
               : std::vector{limit, std::max(1.0, (1 - spread) * limit), (1 + spread) * limit};
}

/// Returns the layers of the mesh without its negative volumes, after gaps of each part are closed.
inline LayerStack sections_of(const VerifyOptions& options, const Plan& plan, const Execution& execution) {
    if (!options.close_gaps_mm)
        return options.subtracts() ? slice(*options.plate, plan, {.execution = execution})
                                   : slice(*options.mesh, plan, {.execution = execution});
    LayerStack layers;
    const double within = *options.close_gaps_mm;
    const LayerLimits limits = layer_limits(execution, options.max_memory, 0);
    if (!options.plate) {
        for (const Layer& layer : slice(*options.mesh, plan, {.execution = execution}))
            layers.push_back(close_gaps(layer, within, limits).layer);
        return layers;
    }
    const LayerSink keep = appending_to(layers);
    const PlateSink of_parts{.prepare = [&](const Plane& bodies) {
        const ClosedPlane closed = close_gaps_on_plane(bodies.polylines, within, limits);
        return keep.prepare(merged(material_of(closed.layers, options.plate->negatives, {}, limits).parts));
    }};
    slice_to(of_parts, *options.plate, plan, {.execution = execution});
    return layers;
}

/// Returns these layers after these steps.
inline LayerStack layers_of(const VerifyOptions& options, const Plan& plan, const LayerSteps& steps,
                            const Execution& execution) {
    std::vector<LayerStack> layers;
    layers.push_back(sections_of(options, plan, execution));
    return std::move(
        take_steps(steps, std::move(layers), {.execution = execution, .max_memory = options.max_memory})
            .parts.front());
}

} // namespace lamella
