#pragma once

// Triangles that share their vertices by index.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include <array>
#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Vertices (#V by 3, double) and triangles (#T by 3, indices into the vertices, counter-clockwise seen from
/// outside). Vertices may be repeated: those with equal coordinates are the same vertex (see Mesh). Some
/// functions that take an IndexedMesh compare vertices by index only; their contracts state it. There are at
/// most 2^32 - 1 vertices and 2^32 - 1 triangles; functions that would need more throw Error{limit}.
struct IndexedMesh {
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// Returns the corners of triangle i.
[[nodiscard]] inline Triangle3 corners(const IndexedMesh& mesh, std::size_t i) noexcept {
    const std::array<std::uint32_t, 3>& t = mesh.triangles[i];
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// Applies the placement of a soup and joins equal corners: exactly, without a tolerance, with -0 equal to
/// +0. Vertices are numbered in the order of their first occurrence, which keeps the locality of the file,
/// and triangle i of the soup is triangle i of the mesh. The result is the same for any number of threads.
/// Throws Error{limit} beyond 2^32 - 1 triangles, and if more than 2^32 - 1 corners differ from the corners
/// shortly before them in the file. Expected O(n), worst case O(n log n).
[[nodiscard]] IndexedMesh weld(const TriangleSoup& soup, const Execution& execution = {});

/// Joins the equal vertices of a mesh, which files contain where neighbouring faces do not share a vertex.
/// Each vertex is replaced by the first one equal to it, with -0 equal to +0. Triangles and vertices keep
/// their order; vertices without a triangle are kept. The result is the same for any number of threads.
/// Expected O(n), worst case O(n log n).
[[nodiscard]] IndexedMesh weld(IndexedMesh mesh, const Execution& execution = {});

/// Throws Error{input} that names the first triangle with an index out of range, or the first vertex that is
/// not finite or has a coordinate beyond 1e100 mm, for which sums overflow. All functions that follow indices
/// throw these errors, except `corners`, which requires a mesh that passes this check.
void check(const IndexedMesh& mesh);

/// Drops vertices that no triangle uses; the others keep their order. Works in place. Throws
/// Error{cancelled}. O(vertices + triangles).
void drop_unused_vertices(IndexedMesh& mesh, const Execution& execution = {});

/// Returns the box of all vertices, used or not. Empty for a mesh without vertices.
[[nodiscard]] Box3 bounding_box(const IndexedMesh& mesh, const Execution& execution = {});

/// Returns the signed volume in mm^3, with the same bits as the volume of the soup from which the mesh was
/// welded.
[[nodiscard]] double volume(const IndexedMesh& mesh, const Execution& execution = {});

/// Returns the transformed mesh. If the map mirrors, triangles are flipped so that they stay
/// counter-clockwise seen from outside.
[[nodiscard]] IndexedMesh transformed(IndexedMesh mesh, const Transform& map);

} // namespace lamella
LAMELLA_API_END
