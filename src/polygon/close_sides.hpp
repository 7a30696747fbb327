#pragma once

// Finds sides of rings that come close to other sides.

#include "lamella/contour/layer.hpp"

#include <vector>

namespace lamella {

/// Returns for each point of a layer whether the side that begins there may come within `reach` of another
/// side. Consecutive sides are compared apart from their common end. Every close side is marked; some others
/// are marked, too. Rings of one point are ignored. Requires a layer without open chains. O(points) for rings
/// with few close sides; if it would take many steps for each point, all sides are marked.
[[nodiscard]] std::vector<bool> close_sides(const Layer& rings, double reach);

} // namespace lamella
