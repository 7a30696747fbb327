#pragma once

// Reading the Open Vector Format (docs/formats.md).

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include <string>
#include <string_view>

namespace lamella {

class ReadLimits;

[[nodiscard]] bool is_ovf(std::string_view bytes);

/// Throws Error{input} naming the byte.
[[nodiscard]] LayerFile read_ovf(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                 const Execution& execution);

} // namespace lamella
