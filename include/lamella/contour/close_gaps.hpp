#pragma once

// Closes gaps in layers with open chains by joining ends that are close to one another.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A join of the last point `from` of a chain with the first point `to` of the same or another chain.
struct GapJoin {
    Point2 from;
    Point2 to;
    double length_mm = 0;
};

struct ClosedGaps {
    Layer layer;                ///< in normal form; contours without joins are unchanged
    std::vector<GapJoin> joins; ///< complete, in the order in which they were made: the shortest first
    double longest_mm = 0;
    double total_mm = 0;
    std::uint64_t refused = 0;  ///< pairs of free ends that were close enough but were not joined, see below
    std::uint64_t left_out = 0; ///< ends that were dropped because chains overlapped, see below
};

/// Joins the last point of a chain to the first point of the same or another chain if these are at most
/// `within_mm` apart. Material thus stays on the left. Pairs are joined in ascending order of distance, equal
/// distances in the order of the coordinates of their ends. Each end is joined at most once. A chain joined
/// to itself becomes a ring.
///
/// A pair is refused if the straight line between the ends would cross a contour or an earlier join, or pass
/// through a point of one. A pair is also refused if the join would make a ring of fewer than three points,
/// or would close a single chain that is shorter than twice its gap: a short straight chain is no ring. For
/// each last point, only the 64 closest first points are examined.
///
/// If the two chains overlap, so that the segments before and after the join cross, one of the two joined
/// points is dropped, unless the new segment would cross another one. This happens where a vertex lies on the
/// edge of a neighbour (a T-junction): both points differ by rounding.
///
/// A layer without chains is returned as it is. Throws Error{usage} for a distance that is not a positive
/// finite number, Error{limit} if more pairs of ends are close enough than `limits` allow, and
/// Error{cancelled}. O(n + c log c) for n points and c chains, and 64 pairs for each chain at worst, also
/// where many ends are close to one another. The exception is a great number of long segments, which no grid
/// separates.
[[nodiscard]] ClosedGaps close_gaps(const Layer& layer, double within_mm, const LayerLimits& limits = {});

struct ClosedPlane {
    std::vector<Layer> layers;
    std::vector<GapJoin> joins; ///< of the first layer, then of the second, and so on
};

/// Closes the gaps of several layers on one plane, each by itself. Throws the errors of close_gaps.
[[nodiscard]] ClosedPlane close_gaps_on_plane(std::span<const Layer> layers, double within_mm,
                                              const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
