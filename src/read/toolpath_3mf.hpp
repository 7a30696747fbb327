#pragma once

// Reading 3MF with toolpaths (3MF Toolpath Extension 1.0).

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include "read/opc_package.hpp"

namespace lamella {

class ReadLimits;

/// Whether the model of the package refers to layers of toolpaths.
[[nodiscard]] bool is_toolpath_3mf(const OpcPackage& package);

/// Throws Error{input} naming the part of the package and the line.
[[nodiscard]] LayerFile read_toolpath_3mf(const OpcPackage& package, ReadLimits& limits,
                                          const Execution& execution);

} // namespace lamella
