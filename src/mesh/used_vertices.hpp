#pragma once

// Vertices that triangles use.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"

namespace lamella {

/// Like the public function, with an existing executor.
void drop_unused_vertices(IndexedMesh& mesh, Executor& executor);

} // namespace lamella
