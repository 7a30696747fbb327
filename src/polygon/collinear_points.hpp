#pragma once

// Removes collinear points of rings.

#include "lamella/contour/layer.hpp"

namespace lamella {

/// Returns the layer without collinear points of its rings, to within `tolerance` mm. Where a mesh has two
/// triangles in one plane, a section through it has such a point on their common edge. No removed point is
/// farther than `tolerance` from the new ring. The first points of rings remain. Unchanged are open chains,
/// rings of which fewer than three points would remain, and layers so small or large that squares of their
/// lengths could underflow or overflow. O(points).
[[nodiscard]] Layer remove_collinear_points(const Layer& layer, double tolerance);

} // namespace lamella
