#pragma once

// Rings with each side moved in parallel.

#include "lamella/contour/layer.hpp"
#include "lamella/polygon/offset.hpp"

#include "core/layer_budget.hpp"

#include <span>
#include <vector>

namespace lamella {

/// Returns for each distance the rings of a layer, in their order, with each side moved to the right by the
/// distance, to the left if it is negative. Boundaries of material are thus moved outwards or inwards. Rings
/// marked in `gone` become empty.
///
/// Moved rings may intersect themselves and one another. The grown or shrunk material is the area where their
/// common winding number is above 0. If no moved side runs backwards and no rings meet, the rings bound it
/// directly. O(points) for each distance.
[[nodiscard]] std::vector<Layer> moved_rings(const Layer& layer, std::span<const double> distances,
                                             const OffsetCorners& corners,
                                             std::span<const std::vector<bool>> gone,
                                             const LayerBudget& budget = {});

/// Returns the distance from sides and corners up to which strips and wedges surely cover all points.
[[nodiscard]] double surely_swept(double distance, const OffsetCorners& corners) noexcept;

} // namespace lamella
