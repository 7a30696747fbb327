#pragma once

// How much is missing where the contours of a layer do not close.

#include "lamella/contour/layer.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// The gaps of a layer: from the last point of every chain to the first point of the chain that is taken to
/// go on there.
struct OpenGaps {
    std::uint64_t count = 0; ///< as many as there are open chains
    double longest_mm = 0;
    double total_mm = 0;
    /// The ends of the longest gap.
    Point2 from;
    Point2 to;

    OpenGaps& operator+=(const OpenGaps& other) noexcept;
};

/// Matches last points to first points as `close_gaps` would without a limit and with nothing in the way: the
/// closest pairs first, each end once, and no chain with itself that is not twice as long as its gap, unless
/// nothing else is left. So gaps of up to the longest are within reach of `close_gaps`; where triangles are
/// flipped, a gap is as long as the pieces that run the wrong way.
///
/// A layer without chains costs nothing. O(c log c) for c chains on average. An end that was forestalled 16
/// times takes what is left, in the order of the chains: a layer made to be slow has gaps that are too long.
[[nodiscard]] OpenGaps open_gaps(const Layer& layer);

} // namespace lamella
LAMELLA_API_END
