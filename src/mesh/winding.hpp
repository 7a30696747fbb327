#pragma once

// Winding numbers of a mesh around points.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"

#include <cstddef>
#include <functional>
#include <span>

namespace lamella {

/// Calls visit(point, triangle, winding, worker) for every triangle above a point. The sum of the windings is
/// the winding number of the mesh around the point: 1 inside a closed surface that is counter-clockwise seen
/// from outside, 0 outside, -1 inside one that is inside out. Calls come from all workers at once.
///
/// If the vertical ray from a point hits an edge or a vertex, a half-open rule decides that all triangles at
/// the edge share, so nothing is counted twice or missed. Only whether a triangle lies above a point on it
/// depends on rounding. O(triangles + points) if few triangles lie above or below each point.
void for_triangles_above(
    Executor& executor, const IndexedMesh& mesh, std::span<const Point3> points,
    const std::function<void(std::size_t point, std::size_t triangle, int winding, unsigned worker)>& visit);

} // namespace lamella
