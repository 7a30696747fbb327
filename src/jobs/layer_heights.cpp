#include "jobs/layer_heights.hpp"

#include "contour/same_height.hpp"
#include "jobs/layer_check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace lamella {

namespace {

std::vector<const Layer*> from_the_lowest(std::span<const Layer> layers) {
    std::vector<const Layer*> ascending;
    for (const Layer& layer : layers)
        ascending.push_back(&layer);
    std::stable_sort(ascending.begin(), ascending.end(), [](const Layer* a, const Layer* b) {
        return std::tuple(a->bottom, a->top, a->z) < std::tuple(b->bottom, b->top, b->z);
    });
    return ascending;
}

/// Returns the largest difference that rounding may make between equal heights of two layers.
double moved_heights(const Layer& below, const Layer& above, const Rounding& rounding) {
    return moved_cut(below, rounding) + moved_cut(above, rounding) + same_height_mm;
}

} // namespace

void add_height_overlaps(Findings& found, std::span<const Layer> layers, const Rounding& rounding) {
    const Layer* below = nullptr;
    for (const Layer* const above : from_the_lowest(layers)) {
        const double moved = below == nullptr ? 0 : moved_heights(*below, *above, rounding);
        const bool same_height = below != nullptr && above->bottom - below->bottom <= moved &&
                                 std::abs(above->top - below->top) <= moved;
        if (below != nullptr && !same_height && below->top - above->bottom > moved)
            found.note(FindingKind::height_overlaps, [&] {
                return fmt::format("{} begins at z = {:.6g} mm, {} ends at {:.6g} mm", where(*above),
                                   above->bottom, where(*below), below->top);
            });
        if (below == nullptr || above->top > below->top)
            below = above;
    }
}

std::optional<CoveredHeights> covered_heights(std::span<const Layer> layers, const Mesh& mesh,
                                              const Rounding& rounding, const Execution& execution,
                                              Findings& found) {
    const Box3 box = bounding_box(mesh, execution);
    if (layers.empty() || box.empty())
        return std::nullopt;
    const std::vector<const Layer*> ascending = from_the_lowest(layers);
    const Layer* below = ascending.front();
    Plan middles;
    for (const Layer* const above : ascending) {
        if (above->bottom - below->top > moved_heights(*below, *above, rounding))
            middles.layers.push_back({.index = middles.layers.size(),
                                      .z = below->top + (above->bottom - below->top) / 2,
                                      .bottom = below->top,
                                      .top = above->bottom});
        if (above->top > below->top)
            below = above;
    }
    CoveredHeights heights{.bottom = ascending.front()->bottom,
                           .top = below->top,
                           .mesh_bottom = box.min.z,
                           .mesh_top = box.max.z};
    for (const Layer& layer : layers) {
        constexpr double nothing = 1e-6; // rounding of heights
        heights.layers_above += layer.bottom > heights.mesh_top - nothing ? 1 : 0;
        heights.layers_below += layer.top < heights.mesh_bottom + nothing ? 1 : 0;
    }
    if (middles.layers.empty())
        return heights;
    const std::vector<double> areas = section_areas(mesh, middles, execution);
    for (std::size_t i = 0; i < areas.size(); ++i)
        if (const PlannedLayer& gap = middles.layers[i]; areas[i] != 0)
            found.add({.kind = FindingKind::layer_gaps,
                       .count = 1,
                       .amount = gap.top - gap.bottom,
                       .place = fmt::format("from z = {:.6g} to {:.6g} mm", gap.bottom, gap.top)});
    return heights;
}

} // namespace lamella
