#pragma once

// Points that say nothing about a ring.

#include "lamella/contour/layer.hpp"

namespace lamella {

/// The layer without points of rings that lie on the straight way between others, to within `tolerance` mm:
/// where a mesh has two triangles in one plane, a section through it has such a point on the edge between
/// them. No point of a ring that is left out is farther than that from the new one. First points of rings
/// remain, open chains stay as they are; so do rings of which fewer than three points would be left, and
/// layers so small or large that squares of their lengths could be beyond numbers. O(points).
[[nodiscard]] Layer remove_collinear_points(const Layer& layer, double tolerance);

} // namespace lamella
