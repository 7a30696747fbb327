#pragma once

// A triangle in several formats.

#include <string>

namespace lamella::mesh_test::mesh_file_cases {

inline const std::string obj = "# a comment\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

inline const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

inline const std::string ply =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

inline const std::string stl =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
    "endfacet\nendsolid\n";

} // namespace lamella::mesh_test::mesh_file_cases
