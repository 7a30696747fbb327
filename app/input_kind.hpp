#pragma once

// Mesh or layers? Told by the first bytes, so that one command can take either.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"

#include <optional>
#include <string>
#include <variant>

namespace lamella::app {

/// Reads a mesh or a slice file, whichever it is. "-" reads standard input.
[[nodiscard]] std::variant<MeshFile, LayerFile>
read_either(const std::string& path, const MeshReadOptions& options, const Execution& execution);

/// The layers, where the file holds any; a mesh is left unread. Not for "-", which can be read only once.
[[nodiscard]] std::optional<LayerFile> read_if_layers(const std::string& path, const Execution& execution);

} // namespace lamella::app
