#pragma once

// Reading the Common Layer Interface 2.0, ASCII and binary (docs/formats.md).

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace lamella {

class ReadLimits;

/// Whether the bytes hold a Common Layer Interface header. Comments may come before it.
[[nodiscard]] bool is_common_layer(std::string_view bytes);

/// Throws Error{input} naming byte or line.
[[nodiscard]] LayerFile read_common_layer(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                          const Execution& execution);

/// The same for a file of scan vectors: `exposure_of` tells what the part of a label is.
using ExposureOfLabel = std::function<std::optional<Exposure>(std::string_view label)>;
[[nodiscard]] LayerFile read_common_layer(std::string_view bytes, const std::string& name,
                                          const ExposureOfLabel& exposure_of, ReadLimits& limits,
                                          const Execution& execution);

} // namespace lamella
