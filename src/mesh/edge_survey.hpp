#pragma once

// One pass over all edges of a mesh: their defects counted, where somebody asks listed, and what connects.

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
struct EdgePlaces {
    std::vector<VertexPair> boundary;    ///< directed against the triangle's way
    std::vector<VertexPair> nonmanifold; ///< low, high
    std::vector<VertexPair> conflicts;   ///< low, high
    std::vector<std::uint32_t> duplicates;
};

struct EdgeSurvey {
    Inspection counts = {};                    ///< what edges tell: of edges, and duplicate triangles
    std::uint64_t opposite_pairs = 0;          ///< as a Diagnosis has them
    UnionFind parts;                           ///< of triangles connected over edges
    PageArray<std::atomic<std::uint8_t>> open; ///< 1 for some triangle at each edge that is not balanced
    EdgePlaces places = {};
};

/// Counts and sizes of another mesh, or of another piece of one, with those of `sum`.
void add(Inspection& sum, const Inspection& other) noexcept;

[[nodiscard]] EdgeSurvey survey_edges(Executor& executor, const IndexedMesh& mesh, bool with_places);

/// A triangle by its highest vertex, among those whose two lowest vertices one edge joins.
struct TriangleOverEdge {
    std::uint32_t highest;
    std::uint32_t triangle;
    bool upwards; ///< which way round, compared with the others

    friend auto operator<=>(const TriangleOverEdge&, const TriangleOverEdge&) noexcept = default;
};

/// All groups of two or more triangles with the same three vertices, each in ascending order; their own order
/// is any.
[[nodiscard]] std::vector<std::vector<TriangleOverEdge>> find_same_vertices(Executor& executor,
                                                                            const IndexedMesh& mesh);

} // namespace lamella
