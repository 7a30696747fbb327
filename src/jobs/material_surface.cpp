#include "jobs/material_surface.hpp"

#include "lamella/mesh/transform.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

namespace {

using Polygon = std::vector<Point3>;

/// Returns the part of a convex polygon on one side of a plane across an axis: above it, or below.
Polygon clipped(const Polygon& polygon, double Point3::*axis, double at, bool above) {
    const auto inside = [&](const Point3& p) {
        return above ? p.*axis >= at : p.*axis <= at;
    };
    Polygon kept;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Point3& a = polygon[i];
        const Point3& b = polygon[(i + 1) % polygon.size()];
        if (inside(a))
            kept.push_back(a);
        if (inside(a) == inside(b))
            continue;
        const double t = (at - a.*axis) / (b.*axis - a.*axis);
        Point3 cut{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
        cut.*axis = at;
        kept.push_back(cut);
    }
    return kept;
}

/// Returns the part of a triangle inside of a box. A triangle in a horizontal face of the box is not inside,
/// because it bounds no material.
Polygon inside_of(const Box3& box, const Triangle3& triangle) {
    const auto [low, high] = std::minmax({triangle[0].z, triangle[1].z, triangle[2].z});
    if (high <= box.min.z || low >= box.max.z)
        return {};
    Polygon rest(triangle.begin(), triangle.end());
    for (double Point3::*const axis : {&Point3::z, &Point3::x, &Point3::y}) {
        rest = clipped(rest, axis, box.min.*axis, true);
        rest = clipped(rest, axis, box.max.*axis, false);
    }
    return rest;
}

/// Appends a convex polygon as a fan.
void append(IndexedMesh& mesh, const Polygon& polygon) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), polygon.begin(), polygon.end());
    for (std::uint32_t i = 2; i < polygon.size(); ++i)
        mesh.triangles.push_back({first, first + i - 1, first + i});
}

} // namespace

Mesh material_surface(const Plate& plate, const Execution& execution) {
    Mesh parts = joined(plate, execution);
    if (plate.negatives.empty())
        return parts;
    IndexedMesh inside;
    for (const PlateNegative& negative : plate.negatives) {
        const Mesh mesh =
            plate.shapes[negative.shape].mesh.transformed(translation(negative.dx, negative.dy, 0));
        for (const std::size_t part : negative.parts)
            for (std::size_t i = 0; i < mesh.size(); ++i)
                append(inside, inside_of(plate.parts[part].box, mesh.triangle(i)));
    }
    return joined(std::array{std::move(parts), Mesh(std::move(inside))}, execution);
}

} // namespace lamella
