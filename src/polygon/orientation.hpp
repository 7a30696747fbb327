#pragma once

// Segments as a sweep sees them, and on which side of them a point lies.

#include "core/orientation.hpp"
#include "polygon/box2.hpp"

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

/// Whether two segments have a point in common. Exact, for points, too.
[[nodiscard]] inline bool meet(const Segment& s, const Segment& t) noexcept {
    return Box2::of(s.lo, s.hi).meets(Box2::of(t.lo, t.hi)) && side(s, t.lo) * side(s, t.hi) <= 0 &&
           side(t, s.lo) * side(t, s.hi) <= 0;
}

/// Whether each has its ends strictly on both sides of the other one. Exact.
[[nodiscard]] inline bool cross(const Segment& s, const Segment& t) noexcept {
    if (s.lo.x >= t.hi.x || t.lo.x >= s.hi.x)
        return false; // they meet in a common vertical at most, where one of them ends
    const auto [s_min, s_max] = std::minmax(s.lo.y, s.hi.y);
    const auto [t_min, t_max] = std::minmax(t.lo.y, t.hi.y);
    const bool share_an_end = s.lo == t.lo || s.hi == t.hi || s.lo == t.hi || s.hi == t.lo;
    if (s_min >= t_max || t_min >= s_max || share_an_end)
        return false; // a touch at most
    return side(s, t.lo) * side(s, t.hi) < 0 && side(t, s.lo) * side(t, s.hi) < 0;
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
