#include "pipeline/covered_heights.hpp"

#include "contour/same_height.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

namespace lamella {

std::optional<CoveredHeights> covered_heights(std::span<const Layer> layers, const Mesh& mesh,
                                              const Rounding& rounding, const Execution& execution,
                                              std::vector<std::string>& findings) {
    const Box3 box = bounding_box(mesh, execution);
    if (layers.empty() || box.empty())
        return std::nullopt;
    std::vector<const Layer*> ascending;
    for (const Layer& layer : layers)
        ascending.push_back(&layer);
    std::stable_sort(ascending.begin(), ascending.end(),
                     [](const Layer* a, const Layer* b) { return a->bottom < b->bottom; });
    const Layer* below = ascending.front();
    Plan middles;
    for (const Layer* const above : ascending) {
        if (above->bottom - below->top >
            moved_cut(*below, rounding) + moved_cut(*above, rounding) + same_height_mm)
            middles.layers.push_back({.index = middles.layers.size(),
                                      .z = below->top + (above->bottom - below->top) / 2,
                                      .bottom = below->top,
                                      .top = above->bottom});
        if (above->top > below->top)
            below = above;
    }
    CoveredHeights found{.bottom = ascending.front()->bottom,
                         .top = below->top,
                         .mesh_bottom = box.min.z,
                         .mesh_top = box.max.z};
    if (middles.layers.empty())
        return found;
    const std::vector<double> areas = section_areas(mesh, middles, execution);
    const PlannedLayer* first = nullptr;
    for (std::size_t i = 0; i < areas.size(); ++i) {
        if (areas[i] == 0)
            continue;
        const PlannedLayer& gap = middles.layers[i];
        if (found.gaps++ == 0)
            first = &gap;
        found.gaps_mm += gap.top - gap.bottom;
    }
    if (first != nullptr)
        findings.push_back(
            fmt::format("{} between layers, where the mesh has material, {:.6g} mm in all: the "
                        "first from z = {:.6g} to {:.6g} mm",
                        found.gaps == 1 ? "a gap" : fmt::format("{} gaps", found.gaps), found.gaps_mm,
                        first->bottom, first->top));
    return found;
}

} // namespace lamella
