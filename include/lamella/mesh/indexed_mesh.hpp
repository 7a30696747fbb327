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
/// outside). Vertices may be repeated: those with equal coordinates are meant to be the same (see Mesh).
/// Functions of an IndexedMesh itself take sharing at its word, and say so. At most 2^32 - 1 vertices and
/// 2^32 - 1 triangles; functions that would need more throw Error{limit}.
struct IndexedMesh {
    std::vector<Point3> vertices;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// The corners of triangle i.
[[nodiscard]] inline Triangle3 corners(const IndexedMesh& mesh, std::size_t i) noexcept {
    const std::array<std::uint32_t, 3>& t = mesh.triangles[i];
    return {mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]};
}

/// Joins equal corners of a soup: exactly, without a tolerance, with -0 equal to +0, after the placement.
/// Vertices are numbered in the order of their first occurrence, so the locality of the file is kept, and
/// triangle i of the soup is triangle i of the mesh. The result is the same for any number of threads.
/// Expected O(n); hostile input costs O(n log n). Throws Error{limit} beyond 2^32 - 1 triangles, and where
/// more than 2^32 - 1 corners differ from those shortly before them in the file.
[[nodiscard]] IndexedMesh weld(const TriangleSoup& soup, const Execution& execution = {});

/// Joins the equal vertices of a mesh, as files have them where neighbouring faces do not share theirs: each
/// becomes the first one equal to it, with -0 equal to +0. Order is kept, and so are triangles and vertices
/// without one. Expected O(n); hostile input costs O(n log n). The same for any number of threads.
[[nodiscard]] IndexedMesh weld(IndexedMesh mesh, const Execution& execution = {});

/// Throws Error{input} naming the first triangle whose index is out of range or the first vertex that is not
/// finite, or further away than 1e100 mm, where sums overflow. Everything else in this library takes a mesh
/// that passes.
void check(const IndexedMesh& mesh);

/// Drops vertices that no triangle names; the others keep their order. In place, O(vertices + triangles).
/// Throws Error{cancelled}.
void drop_unused_vertices(IndexedMesh& mesh, const Execution& execution = {});

/// The box of all vertices, used or not. Empty for a mesh without vertices.
[[nodiscard]] Box3 bounding_box(const IndexedMesh& mesh, const Execution& execution = {});

/// Signed volume in mm^3, as for a soup. The same bits as for the soup it was welded from.
[[nodiscard]] double volume(const IndexedMesh& mesh, const Execution& execution = {});

/// The mapped mesh. Where the map mirrors, triangles are turned so that they stay counter-clockwise seen from
/// outside.
[[nodiscard]] IndexedMesh transformed(IndexedMesh mesh, const Transform& map);

} // namespace lamella
LAMELLA_API_END
