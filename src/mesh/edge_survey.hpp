#pragma once

// One pass over all edges of a mesh: their defects counted, where somebody asks listed, and what connects.

#include "lamella/mesh/indexed_mesh.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "mesh/union_find.hpp"

#include <atomic>
#include <compare>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

struct EdgeCounts {
    std::uint64_t boundary = 0;
    std::uint64_t nonmanifold = 0;
    std::uint64_t conflicts = 0;
    std::uint64_t duplicate_triangles = 0;
    std::uint64_t opposite_pairs = 0;
};

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
    EdgeCounts counts;
    UnionFind parts;                           ///< of triangles connected over edges
    PageArray<std::atomic<std::uint8_t>> open; ///< 1 for some triangle at each edge that is not balanced
    EdgePlaces places;
};

[[nodiscard]] EdgeSurvey survey_edges(Executor& executor, const IndexedMesh& mesh, bool with_places);

/// Triangles with the same three vertices, in ascending order.
struct SameVertices {
    struct Member {
        std::uint32_t triangle;
        bool upwards; ///< which way round, compared with the other members
    };
    std::vector<Member> triangles; ///< two or more
};

/// All such groups: one list for each worker, so their order is any.
[[nodiscard]] std::vector<std::vector<SameVertices>> find_same_vertices(Executor& executor,
                                                                        const IndexedMesh& mesh);

} // namespace lamella
