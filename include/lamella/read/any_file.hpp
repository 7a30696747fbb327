#pragma once

// Reading a mesh or layers, for whoever takes either.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"

#include <cstddef>
#include <span>
#include <string>
#include <variant>

LAMELLA_API_BEGIN
namespace lamella {

/// Reads a mesh file or a slice file, whichever it is by its content: what `read_mesh` or `read_layers` gives
/// and throws. A package such as 3MF may hold both; then it is read for its layers, as its meshes are mostly
/// stand-ins. "-" reads standard input. `max_memory` holds for layers, too.
[[nodiscard]] std::variant<MeshFile, LayerFile>
read_any(const std::string& path, const MeshReadOptions& options = {}, const Execution& execution = {});

/// The same from bytes in memory; `name` stands for the path in errors.
[[nodiscard]] std::variant<MeshFile, LayerFile> read_any(std::span<const std::byte> bytes,
                                                         const std::string& name,
                                                         const MeshReadOptions& options = {},
                                                         const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
