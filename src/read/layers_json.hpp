#pragma once

// Our own JSON of layers. docs/formats.md describes it.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include <string>
#include <string_view>

namespace lamella {

/// Whether the bytes begin as a JSON document does.
[[nodiscard]] bool is_json(std::string_view bytes);

[[nodiscard]] LayerFile read_layers_json(std::string_view bytes, const std::string& name,
                                         const Execution& execution);

} // namespace lamella
