#pragma once

// Directions of the sides of rings.

#include "lamella/core/point.hpp"

#include <cmath>

namespace lamella {

/// A side of a ring: its direction, of length 1, and its length.
struct RingSide {
    RingSide(const Point2& a, const Point2& b) noexcept : way{b.x - a.x, b.y - a.y} {
        length = std::sqrt(way.x * way.x + way.y * way.y);
        if (length > 0)
            way = {way.x / length, way.y / length};
    }

    Point2 way;
    double length;
};

[[nodiscard]] inline double cross(const Point2& a, const Point2& b) noexcept {
    return a.x * b.y - a.y * b.x;
}
[[nodiscard]] inline double dot_product(const Point2& a, const Point2& b) noexcept {
    return a.x * b.x + a.y * b.y;
}

} // namespace lamella
