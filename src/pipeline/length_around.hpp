#pragma once

// How long the edges of a hatched area are.

#include "lamella/contour/layer.hpp"

namespace lamella {

/// An upper bound of the length of the edges of what lines fill, as it can be told from the lines alone: two
/// points each, in any order, `distance_mm` apart, in a few directions. Between directions there are edges,
/// too, as of the squares of a chessboard. O(n log n).
[[nodiscard]] double length_around(const PointArray& lines, double distance_mm);

} // namespace lamella
