#pragma once

// A body of an exact size.

#include "lamella/core/point.hpp"

#include <span>

namespace lamella {

/// Moves and stretches points along the axes so that their box goes from the origin to `size`. Their own box
/// must not be flat.
inline void fit_box(std::span<Point3> points, const Point3& size) {
    Box3 box;
    for (const Point3& p : points)
        box.add(p);
    const Point3 stretch{size.x / (box.max.x - box.min.x), size.y / (box.max.y - box.min.y),
                         size.z / (box.max.z - box.min.z)};
    for (Point3& p : points)
        p = {(p.x - box.min.x) * stretch.x, (p.y - box.min.y) * stretch.y, (p.z - box.min.z) * stretch.z};
}

} // namespace lamella
