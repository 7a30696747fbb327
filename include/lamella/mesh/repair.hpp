#pragma once

// Policies for meshes that are not sound. Nothing in this library applies them by itself: who wants one calls
// it, and is told what it did. Each takes a mesh and gives another; the order to apply them in is that of
// this page.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// How many places a report lists; its counts are complete.
inline constexpr std::size_t repair_places = 16;

struct ToleranceWeld {
    IndexedMesh mesh;
    std::uint64_t joined_vertices = 0;     ///< replaced by another one
    std::uint64_t collapsed_triangles = 0; ///< dropped, because two of their corners became one
    std::uint64_t pairs_apart = 0;         ///< within the tolerance, but not joined: see below
    double longest_move_mm = 0;
    std::vector<Point3> places; ///< where vertices were moved to, lexicographically, the first few
};

/// Joins vertices that are close to one another, so that cracks of that width close.
///
/// Pairs of vertices no further apart than the tolerance are gone through, the closest first, equally close
/// ones by their coordinates. A pair joins the groups of its two vertices, unless the box of both groups
/// would have a diagonal above the tolerance: so no vertex moves further than the tolerance, there are no
/// chains, and where vertices are dense compared with the tolerance some pairs stay apart. A group becomes
/// the lexicographically smallest of its points. Triangles keep their order; those that lose a corner are
/// dropped.
///
/// The same points for any order of vertices and triangles. O(n log n) for n vertices and pairs within the
/// tolerance. Throws Error{usage} for a tolerance that is not a positive finite number, and where it is so
/// large that there would be more than some 64 pairs per vertex.
[[nodiscard]] ToleranceWeld weld_within(const IndexedMesh& mesh, double tolerance_mm,
                                        const Execution& execution = {});

struct DroppedDuplicates {
    IndexedMesh mesh;
    std::uint64_t repeated_triangles = 0; ///< dropped: the same way round as one that was kept
    std::uint64_t opposite_triangles = 0; ///< dropped: in pairs that run opposite ways
    std::vector<Point3> places;           ///< middles of the first few
};

/// Drops triangles that have the same three vertices as others. Of those, the ones that run one way and the
/// ones that run the other cancel in pairs, since between the two there is nothing; of what is left the first
/// one stays. So a body stored twice is there once, a wall between two bodies that touch vanishes, and a body
/// stored together with its inside-out copy vanishes altogether. Triangles keep their order; vertices that
/// nothing uses any more are dropped. Expected O(n).
[[nodiscard]] DroppedDuplicates drop_duplicates(const IndexedMesh& mesh, const Execution& execution = {});

struct OrientedMesh {
    IndexedMesh mesh;
    std::uint64_t patches = 0;
    std::uint64_t turned_triangles = 0;  ///< that now run the other way round
    std::uint64_t turned_outward = 0;    ///< patches turned with all tied to them, once these agree
    std::uint64_t turned_inward = 0;     ///< likewise
    std::uint64_t one_sided_patches = 0; ///< that cannot be made consistent, such as a Moebius strip
    std::vector<Point3> places;          ///< middles of the first few triangles turned
};

/// Turns triangles so that neighbours agree and material lies inside.
///
/// A patch is a part of the mesh connected over edges of exactly two triangles. Within a patch all triangles
/// are made to run like the majority. Patches that meet at edges of more triangles are tied to one another as
/// they are, where such an edge is used as often one way as the other, or with one of them turned, where that
/// makes it so; again, the smaller part is turned. Thus where no edge is in conflict, none is afterwards.
///
/// Then what is tied together is turned as a whole, if need be: outward, or inward when it lies in an odd
/// number of others that are closed: a void. (It lies in what winds around the middle of its largest
/// triangle, and whose box holds its box, and whose surface it does not cross. If it touches that, it stays.)
/// Outward means of positive volume; that of what has open edges is measured from the middle of the box
/// around these. What has a volume of the size of its rounding, or would be closed by fans of nearly half its
/// area or more, stays; so do one-sided patches.
///
/// So a body within a body, both outward, becomes a void in it: who means the inner one to be filled does not
/// call this. The same result for any order of triangles and for any of their corners first: ties are decided
/// by the lexicographically smallest triangle. Expected O(n) for patches that few triangles lie above or
/// below, times the rounds in which turned patches make others fit: a few. Of n patches in one another
/// O(n^2). Throws Error{limit} beyond 2^31 - 1 triangles.
[[nodiscard]] OrientedMesh orient(const IndexedMesh& mesh, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
