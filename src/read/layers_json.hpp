#pragma once

// Our own JSON of layers. docs/formats.md describes it.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include <string>
#include <string_view>

namespace lamella {

class ReadLimits;

/// Whether the bytes begin as a JSON document does.
[[nodiscard]] bool is_json(std::string_view bytes);

[[nodiscard]] LayerFile read_layers_json(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                         const Execution& execution);

} // namespace lamella
