#pragma once

// Which sides of rings come close to others.

#include "lamella/contour/layer.hpp"

#include <vector>

namespace lamella {

/// For each point of a layer that has rings only, whether the side that begins there may come as close as
/// `reach` to another one; of two sides that follow each other, beside the end that both have. A side that
/// does is never left out, some others are not either. Rings of one point count for nobody else. O(points)
/// for rings of which few sides are close; where it would take many steps for each point, all sides are told
/// to be close.
[[nodiscard]] std::vector<bool> close_sides(const Layer& rings, double reach);

} // namespace lamella
