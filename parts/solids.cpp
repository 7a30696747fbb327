#include "lamella/core/error.hpp"
#include "lamella/core/unit_circle.hpp"

#include "parts/icosahedron.hpp"
#include "parts/shapes.hpp"
#include "parts/single_precision.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace lamella {

namespace {

void require_length(const char* what, double mm) {
    if (!(mm >= 1e-9 && mm <= 1e9))
        throw Error(ErrorKind::usage, fmt::format("cannot make {} of {} mm: expected 1e-9 to 1e9", what, mm));
}

void require_segments(const char* what, unsigned segments) {
    if (segments < 3 || segments > 100'000)
        throw Error(ErrorKind::usage,
                    fmt::format("cannot make {} of {} segments: expected 3 to 100000", what, segments));
}

void add_quad(std::vector<Triangle3f>& out, const Point3& a, const Point3& b, const Point3& c,
              const Point3& d) {
    out.push_back({single(a), single(b), single(c)});
    out.push_back({single(a), single(c), single(d)});
}

/// Returns the corners of the regular polygon on the unit circle, with the first one repeated at the end.
std::vector<CosSin> circle(unsigned segments) {
    std::vector<CosSin> out(segments + 1);
    for (unsigned i = 0; i <= segments; ++i)
        out[i] = cos_sin_turn(i, segments);
    return out;
}

/// Returns the bisector of two directions. It is commutative, so both triangles at an edge get the same bits.
Point3 between(const Point3& a, const Point3& b) {
    const Point3 sum{a.x + b.x, a.y + b.y, a.z + b.z};
    const double length = std::sqrt(sum.x * sum.x + sum.y * sum.y + sum.z * sum.z);
    return {sum.x / length, sum.y / length, sum.z / length};
}

void subdivide(std::vector<Triangle3f>& out, const Triangle3& t, unsigned level, double radius) {
    if (level == 0) {
        const auto at = [radius](const Point3& p) {
            return single({p.x * radius, p.y * radius, p.z * radius});
        };
        out.push_back({at(t[0]), at(t[1]), at(t[2])});
        return;
    }
    const Point3 ab = between(t[0], t[1]);
    const Point3 bc = between(t[1], t[2]);
    const Point3 ca = between(t[2], t[0]);
    subdivide(out, {t[0], ab, ca}, level - 1, radius);
    subdivide(out, {ab, t[1], bc}, level - 1, radius);
    subdivide(out, {ca, bc, t[2]}, level - 1, radius);
    subdivide(out, {ab, bc, ca}, level - 1, radius);
}

} // namespace

TriangleSoup make_box(double x_mm, double y_mm, double z_mm) {
    require_length("a box with an edge", x_mm);
    require_length("a box with an edge", y_mm);
    require_length("a box with an edge", z_mm);
    const auto corner = [&](int i) -> Point3 {
        return {(i & 1) != 0 ? x_mm : 0, (i & 2) != 0 ? y_mm : 0, (i & 4) != 0 ? z_mm : 0};
    };
    std::vector<Triangle3f> out;
    for (const auto& q : std::array<std::array<int, 4>, 6>{
             {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {1, 3, 7, 5}, {3, 2, 6, 7}, {2, 0, 4, 6}}})
        add_quad(out, corner(q[0]), corner(q[1]), corner(q[2]), corner(q[3]));
    return TriangleSoup(std::move(out));
}

TriangleSoup make_sphere(double radius_mm, unsigned level) {
    require_length("a sphere with a radius", radius_mm);
    if (level > 11)
        throw Error(ErrorKind::usage,
                    fmt::format("cannot make a sphere of level {}: expected 0 to 11", level));
    const std::array<Point3, 12> v = icosahedron_corners();
    std::vector<Triangle3f> out;
    out.reserve(std::size_t{20} << (2 * level));
    for (const auto& f : icosahedron_faces)
        subdivide(out, {v[f[0]], v[f[1]], v[f[2]]}, level, radius_mm);
    return TriangleSoup(std::move(out));
}

TriangleSoup make_torus(double ring_radius_mm, double tube_radius_mm, unsigned ring_segments,
                        unsigned tube_segments) {
    require_length("a torus with a ring radius", ring_radius_mm);
    require_length("a torus with a tube radius", tube_radius_mm);
    require_segments("a torus with a ring", ring_segments);
    require_segments("a torus with a tube", tube_segments);
    const double inner = ring_radius_mm - tube_radius_mm;
    const double extent = ring_radius_mm + tube_radius_mm;
    if (!(inner > 0) || !resolvable(2 * std::numbers::pi * tube_radius_mm / tube_segments, extent) ||
        !resolvable(2 * std::numbers::pi * inner / ring_segments, extent))
        throw Error(
            ErrorKind::usage,
            fmt::format("cannot make a torus with a tube radius of {} mm on a ring radius of {} mm: "
                        "expected a tube thinner than the ring, and corners that single precision can "
                        "tell apart",
                        tube_radius_mm, ring_radius_mm));
    const std::vector<CosSin> rings = circle(ring_segments);
    const std::vector<CosSin> tubes = circle(tube_segments);
    const auto at = [&](unsigned i, unsigned j) -> Point3 {
        const double r = ring_radius_mm + tube_radius_mm * tubes[j].cos;
        return {r * rings[i].cos, r * rings[i].sin, tube_radius_mm * tubes[j].sin};
    };
    std::vector<Triangle3f> out;
    out.reserve(std::size_t{2} * ring_segments * tube_segments);
    for (unsigned i = 0; i < ring_segments; ++i)
        for (unsigned j = 0; j < tube_segments; ++j)
            add_quad(out, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
    return TriangleSoup(std::move(out));
}

TriangleSoup make_cylinder(double radius_mm, double height_mm, unsigned segments) {
    require_length("a cylinder with a radius", radius_mm);
    require_length("a cylinder with a height", height_mm);
    require_segments("a cylinder", segments);
    const std::vector<CosSin> turn = circle(segments);
    const auto at = [&](unsigned i, double z) -> Point3 {
        return {radius_mm * turn[i].cos, radius_mm * turn[i].sin, z};
    };
    const Point3f bottom = single({0, 0, 0});
    const Point3f top = single({0, 0, height_mm});
    std::vector<Triangle3f> out;
    out.reserve(std::size_t{4} * segments);
    for (unsigned i = 0; i < segments; ++i) {
        add_quad(out, at(i, 0), at(i + 1, 0), at(i + 1, height_mm), at(i, height_mm));
        out.push_back({single(at(i + 1, 0)), single(at(i, 0)), bottom});
        out.push_back({single(at(i, height_mm)), single(at(i + 1, height_mm)), top});
    }
    return TriangleSoup(std::move(out));
}

} // namespace lamella
