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
    std::vector<VertexPair> boundary;    ///< directed against the triangle
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

/// A triangle, named by its highest vertex among triangles whose two lowest vertices are the same.
struct TriangleOverEdge {
    std::uint32_t highest;
    std::uint32_t triangle;
    bool upwards; ///< orientation, compared with the others

    friend auto operator<=>(const TriangleOverEdge&, const TriangleOverEdge&) noexcept = default;
};

/// Returns all groups of two or more triangles with the same vertices, in any order; each group ascends.
[[nodiscard]] std::vector<std::vector<TriangleOverEdge>> find_same_vertices(Executor& executor,
                                                                            const IndexedMesh& mesh);

} // namespace lamella
