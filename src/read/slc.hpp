#pragma once

// SLC 2.0 of 3D Systems.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include <string>
#include <string_view>

namespace lamella {

class ReadLimits;

[[nodiscard]] bool is_slc(std::string_view bytes);

/// The other format called SLC that a file is of, in words for an error; "" if it is of none.
[[nodiscard]] std::string_view other_slc(std::string_view bytes);

[[nodiscard]] LayerFile read_slc(std::string_view bytes, const std::string& name, ReadLimits& limits,
                                 const Execution& execution);

} // namespace lamella
