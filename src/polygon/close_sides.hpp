#pragma once

// Finds sides of rings that come close to other sides.

#include "lamella/contour/layer.hpp"

#include "polygon/orientation.hpp"

#include <vector>

namespace lamella {

/// Returns whether two segments may come within `reach` of one another. If it returns false, they do not.
[[nodiscard]] bool may_come_within(const Segment& s, const Segment& t, double reach) noexcept;

/// Returns for each point of a layer whether the side that begins there may come within `reach` of another
/// side. For consecutive sides their common end does not count. Every close side is marked, but some others
/// are marked, too. Rings of one point are ignored. Requires a layer without open chains. O(points) for rings
/// with few close sides; if the search takes too many steps per point, all sides are marked.
[[nodiscard]] std::vector<bool> close_sides(const Layer& rings, double reach);

} // namespace lamella
