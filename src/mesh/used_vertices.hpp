#pragma once

// Vertices that triangles name.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"

namespace lamella {

/// As the public one, on workers that are there already.
void drop_unused_vertices(IndexedMesh& mesh, Executor& executor);

} // namespace lamella
