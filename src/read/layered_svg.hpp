#pragma once

// Reading layered SVG as Slic3r writes it (docs/formats.md).

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include <string>
#include <string_view>

namespace lamella {

class ReadLimits;

/// Whether the bytes look like an SVG document.
[[nodiscard]] bool is_svg(std::string_view bytes);

/// Throws Error{input} naming the line.
[[nodiscard]] LayerFile read_layered_svg(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                         const Execution& execution);

} // namespace lamella
