#pragma once

// Is a point inside a mesh?

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace lamella {

/// For each point, how often the counted triangles wind around it: 1 inside a closed surface that is
/// counter-clockwise seen from outside, 0 outside, -1 inside one that is turned inside out.
///
/// counts(point, triangle) says which triangles count for which point. Rays go up from the points. Where a
/// ray meets an edge or a vertex, it is decided by a half-open rule that all triangles at the edge share, so
/// nothing is counted twice or missed; only whether a triangle is above a point depends on rounding, for a
/// point on it. O(triangles + points) for points that few triangles lie above or below.
[[nodiscard]] std::vector<int>
winding_numbers(Executor& executor, const IndexedMesh& mesh, std::span<const Point3> points,
                const std::function<bool(std::size_t point, std::size_t triangle)>& counts);

} // namespace lamella
