#pragma once

// Finds the left end of a ring and its direction there.

#include "lamella/contour/layer.hpp"

#include "polygon/monotone_chains.hpp"
#include "polygon/orientation.hpp"

#include <cstddef>

namespace lamella {

/// The left end of a ring, with the lowest of its edges there.
struct LeftEnd {
    Segment line;           ///< that edge; horizontal and unbounded if all points of the ring lie on a
                            ///< vertical line
    bool rightwards = true; ///< direction of that edge; true for counter-clockwise rings
    bool flat = false;      ///< all points of the ring are collinear
    Point2 smallest;        ///< smallest point of the ring
};

/// Returns the left end of a ring that has points. O(chains of the ring + points at its left end); O(points)
/// if its lowest edge there is folded.
[[nodiscard]] LeftEnd left_end(const Layer& layer, const MonotoneChains& chains, std::size_t ring);

} // namespace lamella
