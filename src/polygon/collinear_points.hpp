#pragma once

// Removes collinear points of rings.

#include "lamella/contour/layer.hpp"

namespace lamella {

/// Returns the layer without those points of its rings that are collinear within `tolerance` mm. Sections of
/// meshes have such points on the common edges of coplanar triangles. No removed point is farther than
/// `tolerance` from the new ring. The first points of rings remain. Open chains, rings with fewer than three
/// remaining points, and layers so small or large that squares of their lengths could underflow or overflow
/// are not changed. O(points).
[[nodiscard]] Layer remove_collinear_points(const Layer& layer, double tolerance);

} // namespace lamella
