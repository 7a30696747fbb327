#include "lamella/polygon/layer_steps.hpp"

#include "lamella/contour/measure.hpp"

#include "core/executor.hpp"

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
    hatches_dropped += other.hatches_dropped;
    area_before_mm2 += other.area_before_mm2;
    area_after_mm2 += other.area_after_mm2;
    return *this;
}

void check_steps(const LayerSteps& steps) {
    const Layer none; // the steps look at what they are asked before they look at a layer
    if (steps.offset_mm != 0)
        static_cast<void>(offset(none, steps.offset_mm, steps.offset_corners));
    if (steps.min_area_mm2 != 0)
        static_cast<void>(without_small_rings(none, steps.min_area_mm2));
    if (steps.simplify_mm != 0)
        static_cast<void>(simplify(none, steps.simplify_mm));
}

Layer take_steps(const LayerSteps& steps, Layer layer, LayerChanges& changes) {
    check_steps(steps);
    changes = {};
    if (!steps.any())
        return layer;
    const Layer before = layer; // shares its points
    bool changed = false;
    if (steps.fill != FillRule::none) {
        Filled filled = fill(layer, steps.fill);
        changes.groups_united = filled.groups_united;
        changes.rings_united = filled.rings_united;
        changes.rings_reversed = filled.rings_reversed;
        changes.rings_dropped = filled.rings_dropped;
        changed = filled.changed();
        if (changed)
            layer = std::move(filled.layer);
    }
    if (steps.offset_mm != 0 && layer.rings > 0) {
        layer = offset(layer, steps.offset_mm, steps.offset_corners, &changes.rings_vanished);
        changed = true;
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
        Layer simplified = simplify(layer, steps.simplify_mm);
        changes.points_dropped = layer.points.size() - simplified.points.size();
        changed = changed || changes.points_dropped > 0;
        layer = std::move(simplified);
    }
    if (changed) {
        layer.hatches = {};
        changes.changed_layers = 1;
        changes.hatches_dropped = before.hatches.size() / 2;
        changes.area_before_mm2 = area(before);
        changes.area_after_mm2 = area(layer);
    }
    return layer;
}

LayerStack take_steps(const LayerSteps& steps, LayerStack layers, std::vector<LayerChanges>& each,
                      const Execution& execution) {
    check_steps(steps);
    each.assign(layers.size(), {});
    if (!steps.any())
        return layers;
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::polygon, layers.size());
    executor.for_chunks(layers.size(), 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        for (std::uint64_t i = begin; i < end; ++i) {
            layers[i] = take_steps(steps, std::move(layers[i]), each[i]);
            progress.add(1);
        }
    });
    progress.finish();
    return layers;
}

LayerStack take_steps(const LayerSteps& steps, LayerStack layers, LayerChanges& changes,
                      const Execution& execution) {
    std::vector<LayerChanges> each;
    layers = take_steps(steps, std::move(layers), each, execution);
    changes = {};
    for (const LayerChanges& one : each)
        changes += one;
    return layers;
}

} // namespace lamella
