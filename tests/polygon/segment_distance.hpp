#pragma once

// Computes the distance between a point and a segment in the simplest way.

#include "lamella/core/point.hpp"

#include <algorithm>
#include <cmath>

namespace lamella::test {

inline double distance_from_segment(const Point2& p, const Point2& a, const Point2& b) {
    const double square = (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
    const double along = square > 0 ? ((p.x - a.x) * (b.x - a.x) + (p.y - a.y) * (b.y - a.y)) / square : 0;
    const double share = std::clamp(along, 0.0, 1.0);
    return std::hypot(p.x - a.x - share * (b.x - a.x), p.y - a.y - share * (b.y - a.y));
}

} // namespace lamella::test
