#pragma once

// One pass over all edges of a mesh: counts and lists their defects, and joins connected triangles.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/inspect.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "mesh/union_find.hpp"

#include <atomic>
#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

/// An edge by its vertices.
using VertexPair = std::pair<std::uint32_t, std::uint32_t>;

/// In ascending order.
struct EdgeLocations {
    std::vector<VertexPair> boundary;    ///< in the direction opposite to that of the triangle
    std::vector<VertexPair> nonmanifold; ///< low, high
    std::vector<VertexPair> conflicts;   ///< low, high
    std::vector<std::uint32_t> duplicates;
};

struct EdgeSurvey {
    Inspection counts = {};                    ///< counts of edges and of duplicate triangles
    std::uint64_t opposite_pairs = 0;          ///< as in Diagnosis
    UnionFind parts;                           ///< sets of triangles connected by edges
    PageArray<std::atomic<std::uint8_t>> open; ///< 1 for one triangle at each edge that is not balanced
    EdgeLocations locations = {};
};

/// Adds counts and sizes of another mesh, or of another part of the same mesh, to `sum`.
void add(Inspection& sum, const Inspection& other) noexcept;

[[nodiscard]] EdgeSurvey survey_edges(Executor& executor, const IndexedMesh& mesh, bool with_locations);

/// A triangle, identified by its highest vertex among the triangles with the same two lowest vertices.
struct TriangleOverEdge {
    std::uint32_t highest;
    std::uint32_t triangle;
    bool upwards; ///< true if it runs through the common edge from the lower to the higher vertex

    friend auto operator<=>(const TriangleOverEdge&, const TriangleOverEdge&) noexcept = default;
};

/// Returns all groups of two or more triangles with the same vertices. The groups are in any order, the
/// triangles of a group in ascending order.
[[nodiscard]] std::vector<std::vector<TriangleOverEdge>> find_same_vertices(Executor& executor,
                                                                            const IndexedMesh& mesh);

} // namespace lamella
