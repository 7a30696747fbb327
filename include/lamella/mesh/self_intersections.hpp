#pragma once

// Finds and counts triangles of a mesh that intersect where they should not. Nothing is repaired.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/inspect.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The kind of an intersection of two triangles beyond the vertices and the edge that they share.
enum class IntersectionKind {
    crossing,    ///< each passes through the other
    overlapping, ///< they lie in one plane and their areas overlap
    touching,    ///< they share a point or a segment, and one of them ends there
};

struct TriangleIntersection {
    std::uint32_t triangle_a = 0; ///< below triangle_b
    std::uint32_t triangle_b = 0;
    IntersectionKind kind = IntersectionKind::crossing;
    Point3 at; ///< approximate location
};

/// Numbers of intersecting pairs of triangles between two parts of a mesh, or within one part (a == b).
struct PartIntersections {
    std::uint32_t part_a = 0; ///< not above part_b
    std::uint32_t part_b = 0;
    std::uint64_t crossing = 0;
    std::uint64_t overlapping = 0;
    std::uint64_t touching = 0;
};

struct SelfIntersections {
    std::uint64_t crossing = 0;    ///< number of pairs of triangles; complete
    std::uint64_t overlapping = 0; ///< likewise; two triangles with the same three vertices are such a pair
    std::uint64_t touching = 0;    ///< likewise
    /// Triangles without area (degenerate, or with all corners on a line), which are ignored.
    std::uint64_t flat_triangles = 0;
    /// The first few pairs that cross or overlap, ordered by (triangle_a, triangle_b); then the first few
    /// that touch, in the same order.
    std::vector<TriangleIntersection> first;
    /// Ordered by (part_a, part_b); empty unless parts were given.
    std::vector<PartIntersections> parts;

    [[nodiscard]] std::uint64_t pairs() const noexcept { return crossing + overlapping + touching; }
};

/// The words for intersections in all reports, in the order of IntersectionKind.
struct IntersectionWords {
    std::uint64_t SelfIntersections::*count;
    DefectWords words;
};
inline constexpr std::array<IntersectionWords, 3> intersection_words{
    {{&SelfIntersections::crossing,
      {"crossing", "crossing", "crossings", "two triangles pass through each other"}},
     {&SelfIntersections::overlapping,
      {"overlapping", "overlap", "overlaps", "two triangles lie upon one another in one plane"}},
     {&SelfIntersections::touching,
      {"touching", "touch", "touches", "two triangles meet beside their edges"}}}};
[[nodiscard]] constexpr const DefectWords& words_of(IntersectionKind kind) {
    return intersection_words[static_cast<std::size_t>(kind)].words;
}

struct IntersectionOptions {
    std::size_t keep = 16; ///< largest number of pairs in each half of SelfIntersections::first
    /// The part of each triangle, such as its shell; if empty, `SelfIntersections::parts` stays empty.
    std::span<const std::uint32_t> parts = {};
};

/// Finds all pairs of triangles that have a point in common other than a shared vertex or edge. The decision
/// is exact for the given coordinates. Vertices are compared by index: two vertices of equal coordinates are
/// different, and their triangles touch. Flat triangles are ignored. Throws Error{usage} unless `parts` is
/// empty or has one entry per triangle.
///
/// O(n log n + pairs of triangles with overlapping boxes), on all threads; the result is the same for any
/// number of threads. The search is slow for long slanted triangles, because their boxes overlap many others.
[[nodiscard]] SelfIntersections find_self_intersections(const IndexedMesh& mesh,
                                                        const IntersectionOptions& options = {},
                                                        const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
