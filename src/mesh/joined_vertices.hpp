#pragma once

#include "lamella/core/execution.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include <optional>

namespace lamella {

/// Returns the mesh with equal vertices joined, as `weld` of an IndexedMesh; nullopt if no two are equal.
[[nodiscard]] std::optional<IndexedMesh> joined_vertices(const IndexedMesh& mesh, const Execution& execution);

} // namespace lamella
