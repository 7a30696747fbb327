#pragma once

// OFF, the format of Geomview: the word OFF, three counts, vertices and faces, one on each line.
//
//     OFF
//     3 1 0
//     0 0 0
//     1 0 0
//     0 1 0
//     3 0 1 2

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/byte_source.hpp"

#include <string_view>

namespace lamella {

/// Whether the text begins with a word like OFF: COFF, STNOFF, 4OFF, nOFF...
[[nodiscard]] bool is_off(std::string_view text);

/// Reads an OFF file, with or without its first word; the contract of read_mesh. Colours, normals and texture
/// coordinates are skipped, homogeneous coordinates (4OFF) divided out. Comments (#) are lines of their own.
[[nodiscard]] MeshFile read_off(const ByteSource& source, const MeshReadOptions& options,
                                const Execution& execution);

} // namespace lamella
