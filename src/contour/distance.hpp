#pragma once

#include "lamella/core/point.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

/// Returns the hypotenuse of a right triangle, with the same bits on every processor, so that the same gap is
/// the shortest on all of them. (std::hypot in the C library of Debian rounds differently on ARM64 and
/// x86-64.)
[[nodiscard]] inline double hypotenuse(double dx, double dy) noexcept {
    const double longer = std::max(std::abs(dx), std::abs(dy));
    const double shorter = std::min(std::abs(dx), std::abs(dy));
    if (shorter == 0)
        return longer;
    const double ratio = shorter / longer; // squares of lengths may overflow or underflow
    return longer * std::sqrt(1 + ratio * ratio);
}

[[nodiscard]] inline double distance(const Point2& a, const Point2& b) noexcept {
    return hypotenuse(a.x - b.x, a.y - b.y);
}

/// Returns the distance many times as fast, with different rounding. Requires coordinates whose squares are
/// far from overflow, such as millimetres.
[[nodiscard]] inline double quick_distance(const Point2& a, const Point2& b) noexcept {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    return std::sqrt(dx * dx + dy * dy);
}

/// Returns the square of the distance of p from the segment between a and b.
[[nodiscard]] inline double distance_squared(const Point2& p, const Point2& a, const Point2& b) noexcept {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double px = p.x - a.x;
    const double py = p.y - a.y;
    const double square = dx * dx + dy * dy;
    const double t = square > 0 ? std::clamp((px * dx + py * dy) / square, 0.0, 1.0) : 0.0;
    const double ex = px - t * dx;
    const double ey = py - t * dy;
    return ex * ex + ey * ey;
}

/// Returns the point between a and b that is nearest to p.
[[nodiscard]] inline Point2 nearest_on(const Point2& a, const Point2& b, const Point2& p) noexcept {
    const double dx = b.x - a.x;
    const double dy = b.y - a.y;
    const double square = dx * dx + dy * dy;
    const double along = (p.x - a.x) * dx + (p.y - a.y) * dy;
    if (!(along > 0))
        return a;
    if (along >= square)
        return b;
    return {a.x + along / square * dx, a.y + along / square * dy};
}

} // namespace lamella
