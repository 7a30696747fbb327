#pragma once

// Segments for sweeps, and predicates for points and segments.

#include "contour/box2.hpp"
#include "core/orientation.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

/// A segment for a sweep from left to right: lo < hi, lexicographically.
struct Segment {
    Point2 lo;
    Point2 hi;
};

[[nodiscard]] inline Segment segment_between(const Point2& a, const Point2& b) noexcept {
    return a < b ? Segment{a, b} : Segment{b, a};
}

/// Returns +1 if p lies above the line of s (left of it, if s is vertical), -1 below, 0 on it.
[[nodiscard]] inline int side(const Segment& s, const Point2& p) noexcept {
    return orientation(s.lo, s.hi, p);
}

/// Returns whether two segments have a point in common. Exact, also for segments of length 0.
[[nodiscard]] inline bool meet(const Segment& s, const Segment& t) noexcept {
    return Box2::of(s.lo, s.hi).meets(Box2::of(t.lo, t.hi)) && side(s, t.lo) * side(s, t.hi) <= 0 &&
           side(t, s.lo) * side(t, s.hi) <= 0;
}

/// Returns whether the ends of each segment lie strictly on opposite sides of the other. Exact.
[[nodiscard]] inline bool cross(const Segment& s, const Segment& t) noexcept {
    if (s.lo.x >= t.hi.x || t.lo.x >= s.hi.x)
        return false; // they meet at most on a vertical line where one of them ends
    const auto [s_min, s_max] = std::minmax(s.lo.y, s.hi.y);
    const auto [t_min, t_max] = std::minmax(t.lo.y, t.hi.y);
    const bool share_an_end = s.lo == t.lo || s.hi == t.hi || s.lo == t.hi || s.hi == t.lo;
    if (s_min >= t_max || t_min >= s_max || share_an_end)
        return false; // they touch at most
    return side(s, t.lo) * side(s, t.hi) < 0 && side(t, s.lo) * side(t, s.hi) < 0;
}

/// Does the same as compare_heights in integer arithmetic, which is slow, for the rare cases that
/// compare_heights cannot decide.
[[nodiscard]] int exact_compare_heights(double x, const Segment& s, const Segment& t) noexcept;

/// Returns the sign of the height of s at x minus the height of t at x. Both must span x and neither may be
/// vertical. Exact.
///
/// The filter: let u = 2^-53. The fraction of s to the left of x has three roundings, its rise three more,
/// and the height another one. The height is off by less than 8u (|lo.y| + |hi.y|) if nothing overflows, and
/// the difference of two heights by less than 10u of the sum of sizes. A fraction that underflows is off by
/// less than 2^-1074.
[[nodiscard]] inline int compare_heights(double x, const Segment& s, const Segment& t) noexcept {
    constexpr double u = 0x1p-53;
    const double s_width = s.hi.x - s.lo.x;
    const double t_width = t.hi.x - t.lo.x;
    const double s_height = s.lo.y + (x - s.lo.x) / s_width * (s.hi.y - s.lo.y);
    const double t_height = t.lo.y + (x - t.lo.x) / t_width * (t.hi.y - t.lo.y);
    const double difference = s_height - t_height;
    const double size = std::abs(s.lo.y) + std::abs(s.hi.y) + std::abs(t.lo.y) + std::abs(t.hi.y);
    if (std::isfinite(s_width + t_width) && size > 1e-280 && std::abs(difference) > 16 * u * size)
        return difference > 0 ? 1 : -1;
    return exact_compare_heights(x, s, t);
}

/// Returns the position of s relative to t just to the right of x: -1 below, 0 coincident, 1 above. Both must
/// span x. Exact.
[[nodiscard]] inline int compare_right_of(double x, const Segment& s, const Segment& t) noexcept {
    const int left = s.lo.x > t.lo.x ? side(t, s.lo) : -side(s, t.lo);
    const int right = s.hi.x < t.hi.x ? side(t, s.hi) : -side(s, t.hi);
    if (left * right >= 0)
        return left != 0 ? left : right;
    if (std::max(s.lo.x, t.lo.x) >= x)
        return left;
    const int here = compare_heights(x, s, t);
    return here != 0 ? here : right;
}

} // namespace lamella
