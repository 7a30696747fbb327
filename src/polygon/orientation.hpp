#pragma once

// Segments as a sweep sees them, and on which side of them a point lies.

#include "core/orientation.hpp"

#include <algorithm>

namespace lamella {

/// Segments in the order of a sweep from left to right: lo < hi, lexicographically.
struct Segment {
    Point2 lo;
    Point2 hi;
};

[[nodiscard]] inline Segment segment_between(const Point2& a, const Point2& b) noexcept {
    return a < b ? Segment{a, b} : Segment{b, a};
}

/// +1 when p lies above the line of s, -1 below, 0 on it. (For a vertical segment "above" is to its left.)
[[nodiscard]] inline int side(const Segment& s, const Point2& p) noexcept {
    return orientation(s.lo, s.hi, p);
}

[[nodiscard]] inline double height_at(const Segment& s, double x) noexcept {
    return s.lo.y + (x - s.lo.x) * ((s.hi.y - s.lo.y) / (s.hi.x - s.lo.x));
}

/// How s lies to t just to the right of x, where both exist: -1 below, 0 on it, 1 above. Exact unless they
/// cross somewhere.
[[nodiscard]] inline int compare_right_of(double x, const Segment& s, const Segment& t) noexcept {
    const int left = s.lo.x > t.lo.x ? side(t, s.lo) : -side(s, t.lo);
    const int right = s.hi.x < t.hi.x ? side(t, s.hi) : -side(s, t.hi);
    if (left * right >= 0)
        return left != 0 ? left : right;
    if (std::max(s.lo.x, t.lo.x) >= x)
        return left;
    const double difference = height_at(s, x) - height_at(t, x);
    return difference != 0 ? (difference > 0 ? 1 : -1) : right;
}

} // namespace lamella
