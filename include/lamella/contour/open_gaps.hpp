#pragma once

// Measures the gaps where the contours of a layer do not close.

#include "lamella/contour/layer.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// The gaps of a layer. Each leads from the last point of a chain to the first point of its presumed
/// continuation.
struct OpenGaps {
    std::uint64_t count = 0; ///< equals the number of open chains
    double longest_mm = 0;
    double total_mm = 0;
    /// The ends of the longest gap.
    Point2 from;
    Point2 to;

    OpenGaps& operator+=(const OpenGaps& other) noexcept;
};

/// Matches last points to first points as `close_gaps` would without a limit and without refusals for
/// crossings: the closest pairs first, each end once. A chain is matched with itself only if it is twice as
/// long as its gap, or if no other end remains. So `longest_mm` is a useful limit for `close_gaps`. If
/// triangles are flipped, a gap is as long as the part of the contour that runs in the wrong direction.
///
/// O(1) for a layer without chains, otherwise O(c log c) for c chains on average. If the nearest partners of
/// an end were taken 16 times, the end is matched with any remaining one, in the order of the chains. The
/// gaps of contrived layers may therefore be reported too long.
[[nodiscard]] OpenGaps open_gaps(const Layer& layer);

} // namespace lamella
LAMELLA_API_END
