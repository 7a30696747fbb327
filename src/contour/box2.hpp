#pragma once

// An axis-parallel rectangle.

#include "lamella/core/point.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace lamella {

struct Box2 {
    double x0;
    double y0;
    double x1;
    double y1;

    static Box2 of(const Point2& a, const Point2& b) noexcept {
        return {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x), std::max(a.y, b.y)};
    }
    static Box2 of(const Point2& p) noexcept { return {p.x, p.y, p.x, p.y}; }
    void add(const Box2& other) noexcept {
        x0 = std::min(x0, other.x0);
        y0 = std::min(y0, other.y0);
        x1 = std::max(x1, other.x1);
        y1 = std::max(y1, other.y1);
    }
    [[nodiscard]] Box2 grown(double by) const noexcept { return {x0 - by, y0 - by, x1 + by, y1 + by}; }
    [[nodiscard]] double width() const noexcept { return x1 - x0; }
    [[nodiscard]] double height() const noexcept { return y1 - y0; }
    [[nodiscard]] double largest_coordinate() const noexcept {
        return std::max({std::abs(x0), std::abs(y0), std::abs(x1), std::abs(y1)});
    }
    /// Returns whether the boxes overlap or touch.
    [[nodiscard]] bool meets(const Box2& other) const noexcept {
        return x0 <= other.x1 && other.x0 <= x1 && y0 <= other.y1 && other.y0 <= y1;
    }
};

/// Returns the bounding box of the points, of which there must be at least one.
template <class Points>
[[nodiscard]] Box2 box_of(const Points& points) noexcept {
    assert(points.begin() != points.end());
    Box2 box = Box2::of(*points.begin());
    for (const Point2& p : points)
        box.add(Box2::of(p));
    return box;
}

} // namespace lamella
