#include "lamella/polygon/layer_steps.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "core/executor.hpp"
#include "core/naming.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

namespace {

double area(const Layer& layer) noexcept {
    double sum = 0;
    for (std::size_t i = 0; i < layer.rings; ++i)
        sum += ring_area(layer.contour(i));
    return sum;
}

} // namespace

LayerChanges& LayerChanges::operator+=(const LayerChanges& other) noexcept {
    changed_layers += other.changed_layers;
    groups_united += other.groups_united;
    rings_united += other.rings_united;
    rings_reversed += other.rings_reversed;
    rings_dropped += other.rings_dropped;
    rings_vanished += other.rings_vanished;
    points_dropped += other.points_dropped;
    area_before_mm2 += other.area_before_mm2;
    area_after_mm2 += other.area_after_mm2;
    return *this;
}

void check_steps(const LayerSteps& steps) {
    const Layer none; // steps check their parameters before they examine a layer
    if (steps.offset_mm != 0)
        static_cast<void>(offset(none, steps.offset_mm, {.corners = steps.offset_corners}));
    const BottomInset& bottom = steps.bottom;
    if ((bottom.inset_mm != 0 || bottom.height_mm != 0) &&
        !(bottom.inset_mm > 0 && std::isfinite(bottom.inset_mm) && bottom.height_mm > 0 &&
          std::isfinite(bottom.height_mm)))
        throw Error(ErrorKind::usage,
                    fmt::format("the first layers cannot shrink by {} mm over {} mm; both must be above 0",
                                bottom.inset_mm, bottom.height_mm));
    if (steps.min_area_mm2 != 0)
        static_cast<void>(without_small_rings(none, steps.min_area_mm2));
    if (steps.simplify_mm != 0)
        static_cast<void>(simplify(none, steps.simplify_mm));
}

ChangedLayer take_steps(const LayerSteps& steps, Layer layer, const LayerLimits& limits) {
    check_steps(steps);
    LayerChanges changes;
    if (!steps.any())
        return {std::move(layer), changes};
    const Layer before = layer; // a copy that shares the points
    bool changed = false;
    if (steps.fill != FillRule::none) {
        Filled filled = fill(layer, steps.fill, limits);
        changes.groups_united = filled.groups_united;
        changes.rings_united = filled.rings_united;
        changes.rings_reversed = filled.rings_reversed;
        changes.rings_dropped = filled.rings_dropped;
        changed = filled.changed();
        if (changed)
            layer = std::move(filled.layer);
    }
    if (const double distance = steps.offset_at(layer.z); distance != 0 && layer.rings > 0) {
        CountedOffset moved =
            counted_offset(layer, distance, {.corners = steps.offset_corners, .limits = limits});
        changes.rings_vanished = moved.rings_vanished;
        changed = true;
        layer = std::move(moved.layer);
    }
    const auto select = [&](Layer selected) {
        changes.rings_dropped += layer.rings - selected.rings;
        changed = changed || selected.rings < layer.rings;
        layer = std::move(selected);
    };
    if (steps.largest_only)
        select(largest_body(layer));
    if (steps.min_area_mm2 != 0)
        select(without_small_rings(layer, steps.min_area_mm2));
    if (steps.simplify_mm != 0) {
        Layer simplified = simplify(layer, steps.simplify_mm, limits);
        changes.points_dropped = layer.points.size() - simplified.points.size();
        changed = changed || changes.points_dropped > 0;
        layer = std::move(simplified);
    }
    if (changed) {
        changes.changed_layers = 1;
        changes.area_before_mm2 = area(before);
        changes.area_after_mm2 = area(layer);
    }
    return {std::move(layer), changes};
}

ChangedPlane take_steps_on_plane(const LayerSteps& steps, std::span<const Layer> parts,
                                 const LayerLimits& limits, std::span<const std::string> names) {
    ChangedPlane plane;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        ChangedLayer one = naming(i < names.size() ? names[i] : std::string(),
                                  [&] { return take_steps(steps, parts[i], limits); });
        plane.parts.push_back(std::move(one.layer));
        plane.changes += one.changes;
    }
    plane.changes.changed_layers = std::min<std::uint64_t>(1, plane.changes.changed_layers);
    return plane;
}

ChangedStacks take_steps(const LayerSteps& steps, std::vector<LayerStack> parts,
                         const StackOptions& options) {
    check_steps(steps);
    ChangedStacks stacks{std::move(parts), {}};
    stacks.planes.resize(stacks.parts.empty() ? 0 : stacks.parts.front().size());
    if (!steps.any())
        return stacks;
    Executor executor(options.execution);
    const LayerLimits limits = layer_limits(options.execution, options.max_memory, executor.workers());
    ProgressMeter progress(options.execution, Stage::polygon, stacks.planes.size());
    executor.for_chunks(stacks.planes.size(), 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        for (std::uint64_t i = begin; i < end; ++i) {
            std::vector<Layer> layers;
            for (LayerStack& part : stacks.parts)
                layers.push_back(std::move(part[i]));
            ChangedPlane plane = take_steps_on_plane(steps, layers, limits, options.names);
            stacks.planes[i] = plane.changes;
            for (std::size_t part = 0; part < stacks.parts.size(); ++part)
                stacks.parts[part][i] = std::move(plane.parts[part]);
            progress.add(1);
        }
    });
    progress.finish();
    return stacks;
}

} // namespace lamella
