#pragma once

// Area and centroid as sums over the edges around an area.

#include "lamella/contour/layer.hpp"

#include <cstddef>

namespace lamella {

/// Moments about an origin, which should be close to the area, so that precision is not lost.
struct AreaMoments {
    double area_mm2 = 0;
    /// The integrals of x and y over the area, in mm^3.
    double x_mm3 = 0;
    double y_mm3 = 0;

    /// Adds a directed edge of the boundary, which has the area on its left.
    void add_edge(const Point2& from, const Point2& to, const Point2& origin) noexcept {
        const double ax = from.x - origin.x;
        const double ay = from.y - origin.y;
        const double bx = to.x - origin.x;
        const double by = to.y - origin.y;
        const double twice = ax * by - ay * bx;
        area_mm2 += twice / 2;
        x_mm3 += twice * (ax + bx) / 6;
        y_mm3 += twice * (ay + by) / 6;
    }

    void add(const AreaMoments& other) noexcept {
        area_mm2 += other.area_mm2;
        x_mm3 += other.x_mm3;
        y_mm3 += other.y_mm3;
    }
};

/// Returns the moments of all rings.
inline AreaMoments area_moments(const Layer& layer, const Point2& origin) noexcept {
    AreaMoments moments;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        const auto ring = layer.contour(i);
        for (std::size_t k = 0; k < ring.size(); ++k)
            moments.add_edge(ring[k], ring[k + 1 == ring.size() ? 0 : k + 1], origin);
    }
    return moments;
}

} // namespace lamella
