#pragma once

// Checks of meshes whose members anybody may fill.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"

namespace lamella {

/// Throws the errors of `check` for a mesh; uses all threads. Every public function that follows the indices
/// of an IndexedMesh calls it: it takes a hundredth of the time of an inspection.
void check(const IndexedMesh& mesh, Executor& executor);

} // namespace lamella
