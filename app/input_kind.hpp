#pragma once

// Mesh or layers? Told by the first bytes, so that one command can take either.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"

#include <string>
#include <variant>

namespace lamella::app {

/// Reads a mesh or a slice file, whichever it is. "-" reads standard input. The limit of memory holds for
/// both.
[[nodiscard]] std::variant<MeshFile, LayerFile>
read_either(const std::string& path, const MeshReadOptions& options, const Execution& execution);

} // namespace lamella::app
