#pragma once

// PLY, also called the Stanford format: a head that describes rows, and the rows, as text or binary.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/byte_source.hpp"

#include <string_view>

namespace lamella {

/// Whether the text begins with the line "ply".
[[nodiscard]] bool is_ply(std::string_view text);

/// Reads a PLY file of any of its three forms; the contract of read_mesh. Takes x, y and z of the element
/// "vertex" and the list "vertex_indices" or "vertex_index" of the element "face", wherever they stand and of
/// whatever type; all else is skipped.
[[nodiscard]] MeshFile read_ply(const ByteSource& source, const MeshReadOptions& options,
                                const Execution& execution);

} // namespace lamella
