#pragma once

// The winding number of a mesh around a point, by the solid angles of its triangles.

#include "lamella/mesh/indexed_mesh.hpp"

#include <cmath>
#include <cstddef>
#include <numbers>

namespace lamella::test {

/// Returns the winding number, which is whole for a point that is not on a closed mesh.
inline double winding_by_solid_angle(const IndexedMesh& mesh, const Point3& p) {
    double angle = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        Triangle3 t = corners(mesh, i);
        for (Point3& corner : t)
            corner = {corner.x - p.x, corner.y - p.y, corner.z - p.z};
        const auto dot = [](const Point3& a, const Point3& b) {
            return a.x * b.x + a.y * b.y + a.z * b.z;
        };
        const auto length = [&](const Point3& a) {
            return std::sqrt(dot(a, a));
        };
        const Point3& a = t[0];
        const Point3& b = t[1];
        const Point3& c = t[2];
        const double volume =
            a.x * (b.y * c.z - b.z * c.y) + a.y * (b.z * c.x - b.x * c.z) + a.z * (b.x * c.y - b.y * c.x);
        angle += 2 * std::atan2(volume, length(a) * length(b) * length(c) + dot(a, b) * length(c) +
                                            dot(b, c) * length(a) + dot(c, a) * length(b));
    }
    return angle / (4 * std::numbers::pi);
}

} // namespace lamella::test
