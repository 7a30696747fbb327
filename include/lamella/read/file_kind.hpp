#pragma once

// Mesh or layers? For whoever takes either.

#include <string_view>

namespace lamella {

enum class FileKind {
    mesh,   ///< what is none of the others
    layers, ///< of a format that holds nothing else
    either, ///< a package such as 3MF, which may hold a mesh, layers, or both: then its meshes are mostly
            ///< stand-ins
};

/// What a file with these first bytes is for: `read_mesh`, `read_layers`, or one after the other. 4096 bytes
/// are enough; of a file packed with gzip, it is what is packed that counts. Nothing is promised of the file:
/// whether it is in order, its reader says. O(bytes).
[[nodiscard]] FileKind file_kind(std::string_view head);

} // namespace lamella
