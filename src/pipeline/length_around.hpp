#pragma once

// Length of the edges of a hatched area.

#include "lamella/contour/layer.hpp"

namespace lamella {

/// Returns an upper bound of the length of the edges of the area that lines fill. A line has two points;
/// lines have few directions, are `distance_mm` apart, and may be in any order. Boundaries between directions
/// count as edges, too, such as those of the squares of a chessboard. O(n log n).
[[nodiscard]] double length_around(std::span<const Point2> lines, double distance_mm);

} // namespace lamella
