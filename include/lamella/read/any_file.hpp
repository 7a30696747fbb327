#pragma once

// Reads a mesh or layers, for callers that accept both.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <variant>

LAMELLA_API_BEGIN
namespace lamella {

/// Reads a mesh file or a slice file, whose format is recognised by its content, with the results and errors
/// of `read_mesh` or `read_layers`. If a package such as 3MF contains layers and meshes, the layers are read,
/// because the meshes usually are only a preview of them. "-" reads standard input. `max_memory` also applies
/// to layers.
[[nodiscard]] std::variant<MeshFile, LayerFile>
read_any(const std::string& path, const MeshReadOptions& options = {}, const Execution& execution = {});

/// Reads bytes in memory; `name` replaces the path in errors.
[[nodiscard]] std::variant<MeshFile, LayerFile> read_any(std::span<const std::byte> bytes,
                                                         const std::string& name,
                                                         const MeshReadOptions& options = {},
                                                         const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
