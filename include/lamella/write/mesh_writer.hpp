#pragma once

// Writing meshes: STL, PLY and OBJ.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include <string>

namespace lamella {

/// Writes a binary STL file with computed normals, atomically: nobody ever sees half a file. "-" writes
/// standard output. Placed corners are rounded to single precision. Throws Error{output}, and Error{limit}
/// beyond 2^32 - 1 triangles.
void write_stl(const std::string& path, const TriangleSoup& soup);

/// The same as ASCII, with the shortest numbers that read back to the same corners.
void write_stl_ascii(const std::string& path, const TriangleSoup& soup, const std::string& name);

/// Writes a binary little-endian PLY file with the vertices and triangles as they are: in single precision
/// where it holds all of them exactly, else in double. Atomically, "-" and errors as above.
void write_ply(const std::string& path, const IndexedMesh& mesh);

/// Writes an OBJ file with the vertices and triangles as they are, with the shortest numbers that read back
/// to the same coordinates. Atomically, "-" and errors as above.
void write_obj(const std::string& path, const IndexedMesh& mesh, const std::string& name);

} // namespace lamella
