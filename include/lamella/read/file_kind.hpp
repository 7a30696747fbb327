#pragma once

// Mesh or layers? For whoever takes either.

#include "lamella/core/api.hpp"

#include <string_view>

namespace LAMELLA_API lamella {

enum class FileKind {
    mesh,   ///< anything else
    layers, ///< of a format that holds nothing else
    either, ///< a package such as 3MF, which may hold a mesh, layers, or both: then its meshes are mostly
            ///< stand-ins
};

/// What a file with these first bytes is for: `read_mesh`, `read_layers`, or one after the other. 4096 bytes
/// are enough; a file packed with gzip is told by its content. Whether the file is in order only its
/// reader can say. O(bytes).
[[nodiscard]] FileKind file_kind(std::string_view head);

} // namespace lamella
