#pragma once

// Is a point inside a mesh?

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"

#include <cstddef>
#include <functional>
#include <span>

namespace lamella {

/// visit(point, triangle, winding, worker) for every triangle above a point: the sum of the windings is how
/// often the mesh winds around it: 1 inside a closed surface that is counter-clockwise seen from outside, 0
/// outside, -1 inside one that is turned inside out. Calls come from all workers at once.
///
/// Where the ray up from a point meets an edge or a vertex, it is decided by a half-open rule that all
/// triangles at the edge share, so nothing is counted twice or missed; only whether a triangle is above a
/// point depends on rounding, for a point on it. O(triangles + points) for points that few triangles lie
/// above or below.
void for_triangles_above(
    Executor& executor, const IndexedMesh& mesh, std::span<const Point3> points,
    const std::function<void(std::size_t point, std::size_t triangle, int winding, unsigned worker)>& visit);

} // namespace lamella
