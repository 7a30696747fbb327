#pragma once

// On which side of a line a point lies: decided exactly.

#include "lamella/core/point.hpp"

#include <cmath>

namespace lamella {

/// The exact answer by integer arithmetic; slow, for the rare cases that `orientation` cannot decide.
[[nodiscard]] int exact_orientation(const Point2& a, const Point2& b, const Point2& c) noexcept;

/// +1 when c lies to the left of the line from a to b, -1 to the right, 0 on it: the sign of
///     D = (a.x - c.x) (b.y - c.y) - (a.y - c.y) (b.x - c.x) = L - R.
/// Exact for all finite coordinates, denormal and huge ones included.
///
/// The filter. With u = 2^-53 a difference carries one rounding and a product another one, so the computed
/// products l and r are off by |L - l| <= (3u + 7u^2) |l|, and likewise for r. The rounded difference of l
/// and r has the sign of the exact one and at most 1 + u times its size. Hence the computed det has the sign
/// of D when |det| > (1 + u) (3u + 7u^2) (|l| + |r|); the coefficient 3u + 16u^2 also covers the two
/// roundings of the bound itself. A product that underflows is off by 2^-1075 more: with |l| + |r| > 1e-280
/// the slack of the coefficient, more than u^2 (|l| + |r|) / 2, is far above that. Overflow makes a bound of
/// infinity or NaN, and nothing is above those.
[[nodiscard]] inline int orientation(const Point2& a, const Point2& b, const Point2& c) noexcept {
    constexpr double u = 0x1p-53;
    const double ax = a.x - c.x;
    const double ay = a.y - c.y;
    const double bx = b.x - c.x;
    const double by = b.y - c.y;
    const double l = ax * by;
    const double r = ay * bx;
    const double det = l - r;
    const double size = std::abs(l) + std::abs(r);
    if (size > 1e-280 && std::abs(det) > (3 + 16 * u) * u * size)
        return det > 0 ? 1 : -1;
    // The signs of the differences are exact, so are those of L and R; often they decide.
    const auto sign = [](double x) {
        return (x > 0) - (x < 0);
    };
    const int sign_l = sign(ax) * sign(by);
    const int sign_r = sign(ay) * sign(bx);
    if (sign_l != sign_r)
        return sign_l > sign_r ? 1 : -1;
    return sign_l == 0 ? 0 : exact_orientation(a, b, c);
}

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
