#pragma once

// Reads the rows of a binary PLY file.

#include "lamella/core/execution.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "container/read_limits.hpp"
#include "meshes/ply_header.hpp"
#include "meshes/remarks.hpp"
#include "system/byte_source.hpp"

#include <array>

namespace lamella {

/// The rows to read: indices of elements and of their properties.
struct PlyPositions {
    std::size_t vertex = 0;
    std::array<std::size_t, 3> coordinates{};
    std::size_t face = 0;
    std::size_t corners = 0;
    bool strips = false; ///< the rows of `face` are strips of triangles, not faces
};

[[nodiscard]] MeshFile read_ply_binary(const ByteSource& source, const PlyHeader& header,
                                       const PlyPositions& positions, Remarks& remarks, ReadLimits& limits,
                                       const Execution& execution);

} // namespace lamella
