#pragma once

// Reading what has been opened, packed with gzip or not; its content says of which format it is.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/byte_source.hpp"

namespace lamella {

/// The contract of read_mesh, but for MeshFile::path.
[[nodiscard]] MeshFile read_opened_mesh(const ByteSource& opened, const MeshReadOptions& options,
                                        const Execution& execution);

/// The contract of read_layers.
[[nodiscard]] LayerFile read_opened_layers(const ByteSource& opened, const LayerReadOptions& options,
                                           const Execution& execution);

} // namespace lamella
