#pragma once

// Wavefront OBJ: lines of words.
//
//     v 0 0 0
//     v 1 0 0
//     v 0 1 0
//     f 1 2 3
//
// Faces may have any number of corners, each V, V/VT, V//VN or V/VT/VN: numbers of lines of those kinds from
// 1 on, or backwards from -1. Only V is looked at.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/byte_source.hpp"

#include <string_view>

namespace lamella {

/// Whether the text may well be OBJ: OBJ has no mark of its own, so the first line that is no comment must be
/// one that OBJ files begin with.
[[nodiscard]] bool looks_like_obj(std::string_view text);

/// Reads an OBJ file; the contract of read_mesh. All groups and objects are taken together; texture, normals,
/// materials, points and lines are skipped. In parallel, with the same result, errors included, as from front
/// to back.
[[nodiscard]] MeshFile read_obj(const ByteSource& source, const MeshReadOptions& options,
                                const Execution& execution);

} // namespace lamella
