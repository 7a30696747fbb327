#pragma once

// Decides exactly on which side of a line or a plane a point lies.

#include "lamella/core/point.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

/// Compute the exact results in integer arithmetic, which is slow, for the rare cases that `orientation`
/// cannot decide.
[[nodiscard]] int exact_orientation(const Point2& a, const Point2& b, const Point2& c) noexcept;
[[nodiscard]] int exact_orientation(const Point3& a, const Point3& b, const Point3& c,
                                    const Point3& d) noexcept;

/// Returns the sign of (p - origin) . normal: +1 if p lies on the side of a plane that its normal points to,
/// -1 if on the other side, 0 if in the plane. Exact for all finite numbers. It is slow: for points that
/// rounding cannot decide.
[[nodiscard]] int side_of_plane(const Point3& origin, const Point3& normal, const Point3& p) noexcept;

/// Returns +1 if c lies to the left of the line from a to b, -1 if to the right, 0 if on it: the sign of
///     D = (a.x - c.x) (b.y - c.y) - (a.y - c.y) (b.x - c.x) = L - R.
/// Exact for all finite coordinates, including denormal and huge ones.
///
/// The filter: with u = 2^-53, a difference carries one rounding and a product another one, so the computed
/// products l and r have errors |L - l| <= (3u + 7u^2) |l|, and likewise for r. The rounded difference of l
/// and r has the sign of the exact one and at most 1 + u times its size. Hence the computed det has the sign
/// of D if |det| > (1 + u) (3u + 7u^2) (|l| + |r|); the coefficient 3u + 16u^2 also covers the two roundings
/// of the bound itself. A product that underflows has an additional error of 2^-1075: with |l| + |r| > 1e-280
/// the slack of the coefficient, more than u^2 (|l| + |r|) / 2, is far larger. If something overflows, the
/// bound is infinity or NaN, which nothing exceeds.
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
    // The signs of the differences are exact, and so are those of L and R. They often suffice.
    const auto sign = [](double x) {
        return (x > 0) - (x < 0);
    };
    const int sign_l = sign(ax) * sign(by);
    const int sign_r = sign(ay) * sign(bx);
    if (sign_l != sign_r)
        return sign_l > sign_r ? 1 : -1;
    return sign_l == 0 ? 0 : exact_orientation(a, b, c);
}

/// The plane through three points, prepared for testing many points.
///
/// The filter of `likely_side`: each of the six products of three differences carries three roundings of
/// differences, two of products, and at most three of sums. The relative error is below (1 + u)^8 - 1 < 8u +
/// 29u^2 of the sum of sizes `size`, which itself may be too small by 5 roundings; the coefficient 8u +
/// 128u^2 covers both and the rounding of the bound. An underflow of an inner product adds an error of
/// 2^-1075 times the third factor. If that factor is below 1e60 and size is above 1e-200, this is far less
/// than the slack u^2 size, and so is the underflow of the outer product.
class TrianglePlane {
  public:
    TrianglePlane(const Point3& a, const Point3& b, const Point3& c) noexcept : a_(a), b_(b), c_(c) {
        const Point3 p{b.x - a.x, b.y - a.y, b.z - a.z};
        const Point3 q{c.x - a.x, c.y - a.y, c.z - a.z};
        normal_ = {p.y * q.z - p.z * q.y, p.z * q.x - p.x * q.z, p.x * q.y - p.y * q.x};
        sizes_ = {std::abs(p.y * q.z) + std::abs(p.z * q.y), std::abs(p.z * q.x) + std::abs(p.x * q.z),
                  std::abs(p.x * q.y) + std::abs(p.y * q.x)};
    }

    /// Returns the `orientation` of the three points and d, +1 or -1, if it is certain; otherwise 0.
    [[nodiscard]] int likely_side(const Point3& d) const noexcept {
        constexpr double u = 0x1p-53;
        const Point3 r{d.x - a_.x, d.y - a_.y, d.z - a_.z};
        const double det = normal_.x * r.x + normal_.y * r.y + normal_.z * r.z;
        const double size = sizes_.x * std::abs(r.x) + sizes_.y * std::abs(r.y) + sizes_.z * std::abs(r.z);
        const double factor = std::max({std::abs(r.x), std::abs(r.y), std::abs(r.z)});
        if (size > 1e-200 && factor < 1e60 && std::abs(det) > (8 + 128 * u) * u * size)
            return det > 0 ? 1 : -1;
        return 0;
    }
    /// Returns the exact side: the `orientation` of the three points and d, 0 in the plane.
    [[nodiscard]] int side(const Point3& d) const noexcept {
        const int likely = likely_side(d);
        if (likely != 0)
            return likely;
        // All points in one axis-parallel plane: the most frequent case of coplanar points.
        const auto level = [&](double Point3::*k) {
            return a_.*k == b_.*k && a_.*k == c_.*k && a_.*k == d.*k;
        };
        return level(&Point3::x) || level(&Point3::y) || level(&Point3::z) ? 0
                                                                           : exact_orientation(a_, b_, c_, d);
    }

  private:
    Point3 a_;
    Point3 b_;
    Point3 c_;
    Point3 normal_;
    Point3 sizes_; ///< sums of the absolute values of the terms of `normal_`
};

/// Returns +1 if d lies on the side of the plane through a, b and c from which they are counter-clockwise, -1
/// if on the other side, 0 if in it: the sign of
///     D = (b - a) x (c - a) . (d - a).
/// Exact for all finite coordinates.
[[nodiscard]] inline int orientation(const Point3& a, const Point3& b, const Point3& c,
                                     const Point3& d) noexcept {
    return TrianglePlane(a, b, c).side(d);
}

} // namespace lamella
