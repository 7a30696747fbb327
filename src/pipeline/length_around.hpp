#pragma once

// Length of the edges of a hatched area.

#include "lamella/contour/layer.hpp"

namespace lamella {

/// Returns an upper bound of the length of the edges of the area filled by lines, from the lines alone: two
/// points each, in any order, `distance_mm` apart, in a few directions. Boundaries between directions count
/// as edges, too, such as those of the squares of a chessboard. O(n log n).
[[nodiscard]] double length_around(std::span<const Point2> lines, double distance_mm);

} // namespace lamella
