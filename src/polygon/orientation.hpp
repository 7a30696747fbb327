#pragma once

// Segments as a sweep sees them, and on which side of them a point lies.

#include "core/orientation.hpp"

namespace lamella {

/// Segments in the order of a sweep from left to right: lo < hi, lexicographically.
struct Segment {
    Point2 lo;
    Point2 hi;
};

/// +1 when p lies above the line of s, -1 below, 0 on it. (For a vertical segment "above" is to its left.)
[[nodiscard]] inline int side(const Segment& s, const Point2& p) noexcept {
    return orientation(s.lo, s.hi, p);
}

} // namespace lamella
