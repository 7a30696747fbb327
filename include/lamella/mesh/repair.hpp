#pragma once

// Repairs for meshes that are not sound. Nothing in this library applies them by itself: the caller chooses,
// and the result reports the changes. Apply them in the order of this header.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/indexed_mesh.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Largest number of locations in a report; its counts are complete.
inline constexpr std::size_t repair_locations = 16;

struct ToleranceWeld {
    IndexedMesh mesh;
    std::uint64_t joined_vertices = 0;     ///< replaced by another vertex
    std::uint64_t collapsed_triangles = 0; ///< dropped because two of their corners became one
    std::uint64_t pairs_apart = 0;         ///< pairs within the tolerance that were not joined, see below
    double longest_move_mm = 0;
    /// The first few locations to which vertices were moved, in lexicographic order.
    std::vector<Point3> locations;
};

/// Joins vertices that are close to one another, so that cracks up to that width close.
///
/// Every vertex begins as a group of its own. Pairs of vertices no farther apart than the tolerance are
/// visited in ascending order of distance, equal distances in the order of their coordinates. Each pair joins
/// the groups of its two vertices, unless the bounding box of both groups together would have a diagonal
/// above the tolerance. So no vertex moves farther than the tolerance. But where vertices are dense compared
/// with the tolerance, some pairs stay apart. A group becomes the lexicographically smallest of its points.
/// Triangles keep their order; triangles with two corners in one group are dropped.
///
/// The resulting points are the same for any order of vertices and triangles. Throws Error{usage} for a
/// tolerance that is not a positive finite number, and for one so large that there are more than about 64
/// pairs per vertex. O(n log n) for n vertices and pairs within the tolerance.
[[nodiscard]] ToleranceWeld weld_within(const IndexedMesh& mesh, double tolerance_mm,
                                        const Execution& execution = {});

struct DroppedDuplicates {
    IndexedMesh mesh;
    std::uint64_t repeated_triangles = 0; ///< dropped because a triangle with the same orientation was kept
    std::uint64_t opposite_triangles = 0; ///< dropped in pairs of opposite orientation
    std::vector<Point3> locations;        ///< centroids of the first few
};

/// Drops triangles that have the same three vertices as others. Two such triangles of opposite orientation
/// enclose nothing: they cancel in pairs. The first of the remaining ones is kept. So a body that is stored
/// twice remains once, a wall between two touching bodies vanishes, and a body stored together with its
/// inverted copy vanishes, too. Triangles keep their order; vertices that become unused are dropped. Expected
/// O(n).
[[nodiscard]] DroppedDuplicates drop_duplicates(const IndexedMesh& mesh, const Execution& execution = {});

struct OrientedMesh {
    IndexedMesh mesh;
    std::uint64_t patches = 0;
    std::uint64_t flipped_triangles = 0; ///< triangles whose orientation was reversed
    /// Patches flipped outward, as part of a whole group of tied patches.
    std::uint64_t flipped_outward = 0;
    std::uint64_t flipped_inward = 0; ///< likewise, inward
    std::uint64_t non_orientable_patches =
        0;                         ///< patches that cannot be made consistent, such as a Moebius strip
    std::vector<Point3> locations; ///< centroids of the first few flipped triangles
};

/// Flips triangles so that neighbours agree and material lies inside.
///
/// A patch is a part of the mesh connected by edges of exactly two triangles. Within a patch all triangles
/// get the orientation of the majority. Patches that meet at a non-manifold edge are tied to one another. If
/// the edge is balanced (used equally often in both directions), the patches keep their relative orientation.
/// If flipping one of two patches would balance the edge, they are tied with opposite orientations. In each
/// group of tied patches the minority of the triangles is then flipped. So if no edge is in conflict before,
/// none is afterwards.
///
/// Then each group of tied patches is flipped as a whole if necessary, so that it faces outward. A group in
/// an odd number of other closed groups is a void and faces inward. Group A lies in group B if B winds around
/// the centroid of A's largest triangle, B's box contains A's box, and their surfaces do not cross. If their
/// surfaces touch, A keeps its orientation. Outward means that the volume is positive; the volume of a group
/// with open edges is measured from the centre of the box around these edges. Three kinds keep their
/// orientation: non-orientable patches, groups whose volume is 0 within rounding, and groups whose holes
/// would need closing fans of at least 0.45 times the area of the group.
///
/// If a body lies within another one and both are oriented outward, the inner body becomes a void. Do not
/// call this function if the inner body should be filled. The result does not depend on the order of
/// triangles nor on the first corner of each: the lexicographically smallest triangle decides ties. Throws
/// Error{limit} beyond 2^31 - 1 triangles. Expected O(n) per pass if few triangles lie above or below each
/// patch; a flip can require another pass, and a few passes usually suffice. O(n^2) for n nested patches.
[[nodiscard]] OrientedMesh orient(const IndexedMesh& mesh, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
