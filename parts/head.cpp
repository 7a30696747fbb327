// A human head as from a 3D scanner: a fine mesh of uneven triangles over a smooth body with relief.
//
// The body is a rounded union of ellipsoids (skull, jaw, nose, ears, ...). The corners of a subdivided
// icosahedron, randomly displaced, give directions of rays from the origin; the mesh has a vertex where each
// ray leaves the body. These directions form a triangulation of the sphere without folds, so triangles of the
// skin cannot cross, whatever the shape of the body: each has its own cone of rays.
//
// The axes are those of a head that lies on its ear: x towards the crown, y forwards, z sideways. The origin
// lies between the ears. Lengths are in millimetres.

#include "parts/icosahedron.hpp"
#include "parts/shapes.hpp"
#include "parts/shuffle.hpp"
#include "parts/single_precision.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// The icosahedron's edges are divided into this many parts, each of its faces into the square of it.
constexpr unsigned fineness = 153;

/// Largest displacement of a corner along each axis, relative to the distance to its neighbours.
constexpr double unevenness = 0.22;

double length(const Point3& p) {
    return std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
}

// --- the body

struct Ellipsoid {
    Point3 centre;
    Point3 radii;
};

/// Returns the approximate distance from the surface, negative inside.
double distance(const Point3& p, const Ellipsoid& e) {
    const Point3 q{(p.x - e.centre.x) / e.radii.x, (p.y - e.centre.y) / e.radii.y,
                   (p.z - e.centre.z) / e.radii.z};
    const double reach = length(q);
    const double slope = length({q.x / e.radii.x, q.y / e.radii.y, q.z / e.radii.z});
    return slope > 0 ? reach * (reach - 1) / slope : -std::min({e.radii.x, e.radii.y, e.radii.z});
}

/// Returns the smaller of two distances, with the crease rounded where they differ by less than `round`.
double united(double a, double b, double round) {
    const double overlap = std::max(round - std::fabs(a - b), 0.0) / round;
    return std::min(a, b) - overlap * overlap * round / 4;
}

double cut_out(double a, double b, double round) {
    return -united(-a, b, round);
}

constexpr Ellipsoid ear{{17, -8, 35}, {14, 9, 6}};

/// Both sides are equal: only one ear, eye, ... is described.
double head_distance(const Point3& at) {
    const Point3 p{at.x, at.y, std::fabs(at.z)};
    double d = distance(p, {{28, -8, 0}, {47, 48, 36}});                // skull
    d = united(d, distance(p, {{-4, 15, 0}, {42, 31, 28}}), 14);        // face
    d = united(d, distance(p, {{-18, 4, 14}, {20, 24, 12}}), 12);       // jaw
    d = united(d, distance(p, {{-36, 33, 0}, {10, 10, 12}}), 12);       // chin
    d = united(d, distance(p, {{11, 30, 19}, {9, 10, 9}}), 10);         // cheekbone
    d = united(d, distance(p, {{30, 36, 12}, {5, 6, 12}}), 10);         // brow
    d = cut_out(d, distance(p, {{19, 46, 14}, {7, 8, 9}}), 7);          // eye socket
    d = united(d, distance(p, {{19, 34, 14}, {5.5, 6, 7.5}}), 2.5);     // eye
    d = united(d, distance(p, {{10, 44, 0}, {16, 6.5, 4}}), 6);         // bridge of the nose
    d = united(d, distance(p, {{0, 51, 0}, {6, 7, 6}}), 6);             // tip of the nose
    d = united(d, distance(p, {{-2, 45, 6}, {4.5, 6, 4.5}}), 3);        // wing of the nose
    d = united(d, distance(p, {{-14.5, 43.5, 0}, {3.5, 5, 11}}), 4);    // lips
    d = united(d, distance(p, {{-21, 42.5, 0}, {3.5, 5, 9}}), 4);       //
    d = cut_out(d, distance(p, {{-17.8, 49.5, 0}, {1.2, 5, 11}}), 1.5); // mouth
    d = united(d, distance(p, ear), 9);                                 // ear
    d = cut_out(d, distance(p, {{18, -5, 44}, {8, 4.5, 5}}), 3);        // hollow of the ear
    d = united(d, distance(p, {{-98, -12, 0}, {90, 29, 27}}), 12);      // neck
    return -united(-d, p.x + 67, 2);                                    // cut off flat
}

// --- the relief

/// Smooth noise from -1 to 1 without a pattern: values at the corners of unit cubes, blended.
double noise(const Point3& p) {
    const auto value = [](double x, double y, double z) {
        RandomNumbers random(static_cast<std::uint64_t>(static_cast<std::int64_t>(x) * 73856093) ^
                             static_cast<std::uint64_t>(static_cast<std::int64_t>(y) * 19349663) ^
                             static_cast<std::uint64_t>(static_cast<std::int64_t>(z) * 83492791));
        return static_cast<double>(random.next() >> 11) * 0x1p-52 - 1;
    };
    const auto ease = [](double t) {
        return t * t * (3 - 2 * t);
    };
    const auto blend = [](double a, double b, double t) {
        return a + (b - a) * t;
    };
    const Point3 low{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const Point3 t{ease(p.x - low.x), ease(p.y - low.y), ease(p.z - low.z)};
    const auto row = [&](double y, double z) {
        return blend(value(low.x, y, z), value(low.x + 1, y, z), t.x);
    };
    const auto layer = [&](double z) {
        return blend(row(low.y, z), row(low.y + 1, z), t.y);
    };
    return blend(layer(low.z), layer(low.z + 1), t.z);
}

/// Rises smoothly from 0 at `from` to 1 at `to`.
double rise(double x, double from, double to) {
    const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Returns the height of the skin above the smooth body: pores everywhere, strands of hair on the scalp.
double relief(const Point3& p) {
    const double pores =
        0.08 * noise({p.x * 0.9, p.y * 0.9, p.z * 0.9}) + 0.03 * noise({p.x * 2.3, p.y * 2.3, p.z * 2.3});
    const double hairline = 44 - 0.01 * p.z * p.z + 1.5 * noise({p.x * 0.2, p.y * 0.2, p.z * 0.2});
    const double scalp = rise(p.x - 0.95 * (p.y - 20), hairline - 5, hairline + 3) *
                         rise(distance({p.x, p.y, std::fabs(p.z)}, ear), 1, 4);
    const double waves = noise({p.x * 0.35, p.y * 0.09, p.z * 0.35});
    const double strands = noise({p.x * 0.8, p.y * 0.12, p.z * 0.8});
    return pores + scalp * (1.2 + 0.9 * waves + 0.45 * strands);
}

// --- the mesh

/// Returns the point where the ray from the origin first leaves the body; `direction` has length 1. Uses
/// regula falsi in the variant that halves the weight of an end that stays (Illinois; Dowell, Jarratt 1971).
Point3 on_skin(const Point3& direction) {
    const auto along = [&](double t) -> Point3 {
        return {t * direction.x, t * direction.y, t * direction.z};
    };
    double inside = 0;
    double d_inside = head_distance(along(inside));
    double outside = 10;
    double d_outside = head_distance(along(outside));
    while (d_outside < 0) {
        inside = outside;
        d_inside = d_outside;
        outside += std::max(1.5, -0.7 * d_outside);
        d_outside = head_distance(along(outside));
    }
    int side = 0;
    for (int i = 0; i < 12 && outside - inside > 1e-6; ++i) {
        const double t = (inside * d_outside - outside * d_inside) / (d_outside - d_inside);
        const double d = head_distance(along(t));
        if (d < 0) {
            inside = t;
            d_inside = d;
            d_outside = side == -1 ? d_outside / 2 : d_outside;
            side = -1;
        } else {
            outside = t;
            d_outside = d;
            d_inside = side == 1 ? d_inside / 2 : d_inside;
            side = 1;
        }
    }
    const double skin = (inside + outside) / 2;
    return along(skin + relief(along(skin)));
}

/// Returns the direction of a corner of the grid on a face, given by corners of the icosahedron and weights
/// that add up to `fineness`. The displacement depends on the location only, so that faces agree at their
/// edges.
Point3 direction(std::array<std::uint32_t, 3> corners, std::array<unsigned, 3> weights) {
    static const std::array<Point3, 12> icosahedron = icosahedron_corners();
    // The last digit of a sum depends on the order of summands, so they are sorted by corner.
    for (const auto& [i, k] : {std::pair{0, 1}, {1, 2}, {0, 1}})
        if (corners[i] > corners[k]) {
            std::swap(corners[i], corners[k]);
            std::swap(weights[i], weights[k]);
        }
    Point3 p;
    std::uint64_t place = 0;
    for (int i = 0; i < 3; ++i) {
        const Point3& corner = icosahedron[corners[i]];
        p = {p.x + weights[i] * corner.x, p.y + weights[i] * corner.y, p.z + weights[i] * corner.z};
        if (weights[i] > 0)
            place = (place * 16 + corners[i]) * 256 + weights[i];
    }
    RandomNumbers random(place);
    const double edge = length({icosahedron[0].x - icosahedron[1].x, icosahedron[0].y - icosahedron[1].y,
                                icosahedron[0].z - icosahedron[1].z});
    const auto push = [&] {
        return edge * unevenness * (static_cast<double>(random.next() >> 11) * 0x1p-52 - 1);
    };
    const double x = p.x + push();
    const double y = p.y + push();
    const double z = p.z + push();
    const double norm = length({x, y, z});
    return {x / norm, y / norm, z / norm};
}

/// Translates and scales points along the axes so that their box extends from the origin to `size`.
void fit_box(std::span<Point3> points, const Point3& size) {
    Box3 box;
    for (const Point3& p : points)
        box.add(p);
    const Point3 stretch{size.x / (box.max.x - box.min.x), size.y / (box.max.y - box.min.y),
                         size.z / (box.max.z - box.min.z)};
    for (Point3& p : points)
        p = {(p.x - box.min.x) * stretch.x, (p.y - box.min.y) * stretch.y, (p.z - box.min.z) * stretch.z};
}

} // namespace

TriangleSoup make_head() {
    // Each face of the icosahedron has a triangular grid; row i has i + 1 corners.
    constexpr std::size_t per_face = std::size_t{fineness + 1} * (fineness + 2) / 2;
    const auto in_face = [](unsigned row, unsigned column) {
        return std::size_t{row} * (row + 1) / 2 + column;
    };
    std::vector<Point3> corners;
    corners.reserve(icosahedron_faces.size() * per_face);
    for (const std::array<unsigned, 3>& face : icosahedron_faces)
        for (unsigned row = 0; row <= fineness; ++row)
            for (unsigned column = 0; column <= row; ++column)
                corners.push_back(on_skin(direction(face, {fineness - row, row - column, column})));
    fit_box(corners, {141.61, 111.27, 81.29});

    std::vector<Triangle3f> out;
    out.reserve(icosahedron_faces.size() * fineness * fineness);
    for (std::size_t face = 0; face < icosahedron_faces.size(); ++face) {
        const auto at = [&](unsigned row, unsigned column) -> Point3f {
            return single(corners[face * per_face + in_face(row, column)]);
        };
        for (unsigned row = 0; row < fineness; ++row)
            for (unsigned column = 0; column <= row; ++column) {
                out.push_back({at(row, column), at(row + 1, column), at(row + 1, column + 1)});
                if (column < row)
                    out.push_back({at(row, column), at(row + 1, column + 1), at(row, column + 1)});
            }
    }
    return TriangleSoup(std::move(out));
}

} // namespace lamella
