#pragma once

// Where a ring begins, and which way round it runs.

#include "lamella/contour/layer.hpp"

#include "polygon/monotone_chains.hpp"
#include "polygon/orientation.hpp"

#include <cstddef>

namespace lamella {

/// Where a ring begins, from left to right: the lowest of its edges at its left end.
struct LeftEnd {
    Segment line;           ///< of a ring whose points lie on a vertical: level, and without an end
    bool rightwards = true; ///< the direction of that edge: counter-clockwise rings run rightwards there
    bool flat = false;      ///< all points of the ring lie on a line
    Point2 smallest;        ///< of the ring's points
};

/// Of a ring that has points. O(chains of the ring) and the points that are as far to the left as any, unless
/// its lowest edge there is folded: then O(points).
[[nodiscard]] LeftEnd left_end(const Layer& layer, const MonotoneChains& chains, std::size_t ring);

} // namespace lamella
