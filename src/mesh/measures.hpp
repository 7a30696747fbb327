#pragma once

// Measures of a triangle of a mesh.

#include "lamella/mesh/indexed_mesh.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

/// Returns the normal on the side from which the corners are counter-clockwise; its length is twice the area.
[[nodiscard]] inline Point3 normal(const Triangle3& t) noexcept {
    const Point3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
    const Point3 v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
    return {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
}

[[nodiscard]] inline double area(const Triangle3& t) noexcept {
    const Point3 n = normal(t);
    return std::sqrt(n.x * n.x + n.y * n.y + n.z * n.z) / 2;
}

[[nodiscard]] inline Point3 middle(const Triangle3& t) noexcept {
    return {(t[0].x + t[1].x + t[2].x) / 3, (t[0].y + t[1].y + t[2].y) / 3, (t[0].z + t[1].z + t[2].z) / 3};
}

[[nodiscard]] inline Point3 middle(const Box3& box) noexcept {
    return {box.min.x / 2 + box.max.x / 2, box.min.y / 2 + box.max.y / 2, box.min.z / 2 + box.max.z / 2};
}

/// Returns the same corners sorted lexicographically. Results computed from sorted corners depend neither on
/// the first corner nor on the orientation.
[[nodiscard]] inline Triangle3 in_order(Triangle3 t) noexcept {
    std::sort(t.begin(), t.end());
    return t;
}

/// Returns whether the triangle runs through its corners in the order of `in_order`, up to rotation.
[[nodiscard]] inline bool runs_in_order(const Triangle3& t) noexcept {
    return (t[1] < t[0]) == ((t[2] < t[0]) != (t[2] < t[1]));
}

/// Returns the distance with the same bits on every processor, like `hypotenuse` of contour/distance, because
/// the orientation of shells depends on it. No square of a coordinate overflows (core/farthest).
[[nodiscard]] inline double distance(const Point3& a, const Point3& b) noexcept {
    const double x = a.x - b.x;
    const double y = a.y - b.y;
    const double z = a.z - b.z;
    return std::sqrt(x * x + y * y + z * z);
}

} // namespace lamella
