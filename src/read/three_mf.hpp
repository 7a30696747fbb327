#pragma once

// 3MF: a package of model parts, with meshes, assemblies of them, and a build that says what is made where.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/byte_source.hpp"

namespace lamella {

/// Reads what the build of a 3MF file puts on the plate; the contract of read_mesh. Each mesh of the file
/// that is used is one object, each way to it from the build one instance. Of objects of the type
/// surface, which are no solids, nothing is read, nor of those of the type support, unless the options ask
/// for them, nor of items that are not to be printed: a warning says so.
[[nodiscard]] MeshFile read_three_mf(const ByteSource& source, const MeshReadOptions& options,
                                     const Execution& execution);

} // namespace lamella
