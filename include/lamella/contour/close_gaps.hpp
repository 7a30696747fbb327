#pragma once

// A policy for layers with open chains: joining their ends where little is missing between them.

#include "lamella/contour/layer.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A chain was continued from its last point `from` to the first point `to` of a chain, or of itself.
struct GapJoin {
    Point2 from;
    Point2 to;
    double length_mm = 0;
};

struct ClosedGaps {
    Layer layer;                ///< in normal form; what was not joined is as it was
    std::vector<GapJoin> joins; ///< all of them, in the order in which they were made: the shortest first
    double longest_mm = 0;
    double total_mm = 0;
    std::uint64_t refused =
        0; ///< pairs of ends that were free and close enough, but were not joined; see below
    std::uint64_t left_out = 0; ///< ends left out where chains overlapped; see below
};

/// Joins the last point of a chain to the first point of a chain no further away than `within_mm`: material
/// stays on the left. The closest pairs first, equally close ones by the coordinates of the first end, then
/// of the second one; each end once. A chain that meets itself becomes a ring.
///
/// A pair is refused where the straight line between the ends would cross a contour or an earlier join, or
/// run through a point of one; and where it would make a ring of less than three points or of a chain that is
/// not at least twice as long as its gap: a short straight piece is no ring. For each last point the 64
/// closest first points are looked at.
///
/// Where the two chains overlap, so that the segments before and after the join cross, one of the two ends is
/// left out. So it is where a vertex lies on the edge of a neighbour (a T-junction): both ends are one point
/// but for rounding.
///
/// A layer without chains is passed through. O(n + c log c) for n points and c chains that few others are
/// near of. Throws Error{usage} for a distance that is not a positive finite number.
[[nodiscard]] ClosedGaps close_gaps(const Layer& layer, double within_mm);

} // namespace lamella
LAMELLA_API_END
