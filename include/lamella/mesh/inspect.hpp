#pragma once

// What is wrong with a mesh, counted. Nothing is repaired.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include <cstdint>

namespace lamella {

struct Inspection {
    Box3 box;              ///< of all vertices
    double volume_mm3 = 0; ///< signed; meaningful when `closed()`
    double area_mm2 = 0;   ///< of all triangles
    std::uint64_t triangles = 0;
    std::uint64_t vertices = 0;

    /// Edges with one triangle.
    std::uint64_t boundary_edges = 0;
    /// Edges with more than two triangles.
    std::uint64_t nonmanifold_edges = 0;
    /// Edges that triangles run through one way more often than the other; without boundary edges.
    std::uint64_t orientation_conflicts = 0;
    /// Triangles beyond the first with the same three vertices, whichever way round.
    std::uint64_t duplicate_triangles = 0;
    /// Triangles that name a vertex twice: lines or points. They have no edges and belong to no shell.
    std::uint64_t degenerate_triangles = 0;
    /// Parts connected over edges.
    std::uint64_t shells = 0;
    /// Closed shells of negative volume that lie in the material of the others: hollows, as they should be.
    std::uint64_t cavities = 0;
    /// Closed shells of negative volume that do not: turned inside out.
    std::uint64_t inverted_shells = 0;

    /// Every edge is used as often one way as the other: slices have no open chains.
    [[nodiscard]] bool closed() const noexcept { return boundary_edges == 0 && orientation_conflicts == 0; }
    /// Closed, and nothing else counted above.
    [[nodiscard]] bool sound() const noexcept {
        return closed() && nonmanifold_edges == 0 && duplicate_triangles == 0 && degenerate_triangles == 0 &&
               inverted_shells == 0;
    }
};

/// Counts the defects of a mesh. Expected O(n); parallel where it pays; the same result for any number of
/// threads. Degenerate triangles (equal corners) are counted and otherwise ignored, as slicing ignores them.
[[nodiscard]] Inspection inspect(const IndexedMesh& mesh, const Execution& execution = {});

} // namespace lamella
