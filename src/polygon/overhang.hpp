#pragma once

// Measures the material of a layer that the layer below does not carry.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>

namespace lamella {

struct Overhang {
    std::uint64_t bodies = 0; ///< connected areas
    double area_mm2 = 0;
    double width_mm = 0; ///< largest distance of a point of these areas from the material below
};

/// Measures the material of a layer that is farther than `reach_mm` from the material of the layer below,
/// where corners reach as far as in `offset` with mitres. Areas narrower than `least_mm` are left out; it
/// must be above 0. The width may be 5% too small. Both layers must be like LayerCells::layer, and
/// `below` must have material. Costs as much as `offset` and `combine`.
[[nodiscard]] Overhang overhang(const Layer& layer, const Layer& below, double reach_mm, double least_mm,
                                const LayerLimits& limits = {});

} // namespace lamella
