#pragma once

// Reading what has been opened, and unpacked where gzip had packed it; its content says of which format it
// is.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/byte_source.hpp"

namespace lamella {

/// The contract of read_mesh, but for MeshFile::path.
[[nodiscard]] MeshFile read_unpacked_mesh(const ByteSource& source, const MeshReadOptions& options,
                                          const Execution& execution);

/// The contract of read_layers.
[[nodiscard]] LayerFile read_unpacked_layers(const ByteSource& source, const LayerReadOptions& options,
                                             const Execution& execution);

} // namespace lamella
