#pragma once

// Writing meshes: binary STL.

#include "lamella/mesh/triangle_soup.hpp"

#include <string>

namespace lamella {

/// Writes a binary STL file with computed normals, atomically: nobody ever sees half a file. "-" writes
/// standard output. Placed corners are rounded to single precision. Throws Error{output}, and Error{limit}
/// beyond 2^32 - 1 triangles.
void write_stl(const std::string& path, const TriangleSoup& soup);

/// The same as ASCII, with the shortest numbers that read back to the same corners.
void write_stl_ascii(const std::string& path, const TriangleSoup& soup, const std::string& name);

} // namespace lamella
