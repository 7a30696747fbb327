#pragma once

// 3MF with slice stacks (3MF Slice Extension).

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include "read/opc_package.hpp"

namespace lamella {

class ReadLimits;

/// Whether the archive is a 3MF package; whether it has slices shows when it is read.
[[nodiscard]] bool is_3mf(const ZipReader& zip);

[[nodiscard]] LayerFile read_slices_3mf(const OpcPackage& package, ReadLimits& limits,
                                        const Execution& execution);

} // namespace lamella
