#pragma once

// Triangles of a mesh that meet where they should not: found and counted, never mended.

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

/// How two triangles meet beyond the vertices and the edge that they share.
enum class MeetingKind {
    crossing,    ///< each passes through the other
    overlapping, ///< they lie in one plane and have a piece of area in common
    touching,    ///< they have a point or a segment in common, and one of them ends there
};

struct Meeting {
    std::uint32_t triangle_a = 0; ///< below triangle_b
    std::uint32_t triangle_b = 0;
    MeetingKind kind = MeetingKind::crossing;
    Point3 at; ///< about where
};

/// Pairs of triangles of two parts of a mesh (or of one, where a == b).
struct PartMeetings {
    std::uint32_t part_a = 0; ///< not above part_b
    std::uint32_t part_b = 0;
    std::uint64_t crossing = 0;
    std::uint64_t overlapping = 0;
    std::uint64_t touching = 0;
};

struct SelfIntersections {
    std::uint64_t crossing = 0;    ///< pairs of triangles, all of them
    std::uint64_t overlapping = 0; ///< likewise; two triangles with the same three vertices are such a pair
    std::uint64_t touching = 0;    ///< likewise
    /// Triangles without area (degenerate, or with all corners on a line): they were left out.
    std::uint64_t flat_triangles = 0;
    /// The first few that cross or overlap, by (triangle_a, triangle_b); after them the first few that touch.
    std::vector<Meeting> first;
    /// By (part_a, part_b), where parts were given.
    std::vector<PartMeetings> parts;

    [[nodiscard]] std::uint64_t pairs() const noexcept { return crossing + overlapping + touching; }
};

/// How meetings are called wherever they are told, in the order of MeetingKind.
struct MeetingWords {
    std::uint64_t SelfIntersections::*count;
    DefectWords words;
};
inline constexpr std::array<MeetingWords, 3> meeting_words{
    {{&SelfIntersections::crossing,
      {"crossing", "crossing", "crossings", "two triangles pass through each other"}},
     {&SelfIntersections::overlapping,
      {"overlapping", "overlap", "overlaps", "two triangles lie upon one another in one plane"}},
     {&SelfIntersections::touching,
      {"touching", "touch", "touches", "two triangles meet beside their edges"}}}};
[[nodiscard]] constexpr const DefectWords& words_of(MeetingKind kind) {
    return meeting_words[static_cast<std::size_t>(kind)].words;
}

struct MeetingOptions {
    std::size_t keep = 16; ///< bounds SelfIntersections::first, for each half of it
    /// The part that each triangle belongs to, such as its shell; empty: no parts are told.
    std::span<const std::uint32_t> parts = {};
};

/// Finds all pairs of triangles that have a point in common which is not theirs by a shared vertex or edge.
/// Decided exactly, for the coordinates as they are. Sharing is taken at its word: vertices of equal
/// coordinates are two vertices, and their triangles touch. Flat triangles are left out.
///
/// O(n log n + pairs of triangles whose boxes overlap), on all threads; the same result for any number of
/// them. Long triangles aslant in boxes full of others are the slow case. Throws Error{usage} for `parts` of
/// more or fewer triangles than there are.
[[nodiscard]] SelfIntersections find_self_intersections(const IndexedMesh& mesh,
                                                        const MeetingOptions& options = {},
                                                        const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
