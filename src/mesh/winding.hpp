#pragma once

// Winding numbers of a mesh around points.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"

#include <cstddef>
#include <functional>
#include <span>

namespace lamella {

/// Calls visit(point, triangle, winding, worker) for every triangle above a point, from all workers at once.
/// The sum of the windings is the winding number of the mesh around the point: 0 outside of a closed surface,
/// 1 inside if the surface is counter-clockwise seen from outside, -1 inside if it is inside out.
///
/// If the vertical ray from a point hits an edge or a vertex, all triangles there apply the same half-open
/// rule, so that none is counted twice or missed. Rounding matters only for a point on a triangle: it decides
/// whether the triangle counts as above the point. O(triangles + points) if few triangles lie above or below
/// each point.
void for_triangles_above(
    Executor& executor, const IndexedMesh& mesh, std::span<const Point3> points,
    const std::function<void(std::size_t point, std::size_t triangle, int winding, unsigned worker)>& visit);

} // namespace lamella
