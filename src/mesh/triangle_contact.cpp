#include "mesh/triangle_contact.hpp"

#include "core/orientation.hpp"
#include "mesh/measures.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace lamella {

namespace {

using Signs = std::array<int, 3>;
using Flat = std::array<Point2, 3>;

/// Drops the coordinate `axis`.
Point2 projected(const Point3& p, int axis) noexcept {
    return axis == 0 ? Point2{p.y, p.z} : axis == 1 ? Point2{p.z, p.x} : Point2{p.x, p.y};
}

Flat projected(const Triangle3& t, int axis) noexcept {
    return {projected(t[0], axis), projected(t[1], axis), projected(t[2], axis)};
}

bool same(const Signs& s, int value) noexcept {
    return s[0] == value && s[1] == value && s[2] == value;
}

bool both_sides(const Signs& s) noexcept {
    const auto [least, most] = std::minmax({s[0], s[1], s[2]});
    return least < 0 && most > 0;
}

/// Rotates `t` so that its corner 0 is alone on one side of the other triangle's plane, or alone in that
/// plane. Flips the other triangle if necessary, so that no corner of `t` except corner 0 is on the side from
/// which it is counter-clockwise. Reorders `other_signs` likewise.
void put_lone_corner_first(Triangle3& t, const Signs& signs, Triangle3& other, Signs& other_signs) noexcept {
    const auto lone = [&]() -> std::pair<std::size_t, bool> {
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = signs[k];
            const int b = signs[(k + 1) % 3];
            const int c = signs[(k + 2) % 3];
            if (a > 0 && b <= 0 && c <= 0)
                return {k, false};
            if (a < 0 && b >= 0 && c >= 0)
                return {k, true};
        }
        for (std::size_t k = 0; k < 3; ++k) // one corner in the plane, the others on one side
            if (signs[k] == 0)
                return {k, signs[(k + 1) % 3] > 0};
        return {0, false};
    }();
    std::rotate(t.begin(), t.begin() + static_cast<std::ptrdiff_t>(lone.first), t.end());
    if (lone.second) {
        std::swap(other[1], other[2]);
        std::swap(other_signs[1], other_signs[2]);
    }
}

/// Returns whether one corner is in the plane of the other triangle and the two other corners are on one side
/// of that plane, so that the triangles can share only the first corner.
bool in_a_point(const Signs& s) noexcept {
    return std::count(s.begin(), s.end(), 0) == 1 && !both_sides(s);
}

/// Compares triangles in different planes that share no edge. `p_signs` are the signs of p's corners relative
/// to the plane of q.
std::optional<IntersectionKind> contact_in_a_line(Triangle3 p, Triangle3 q, Signs p_signs, Signs q_signs,
                                                  bool share_a_corner) noexcept {
    put_lone_corner_first(p, p_signs, q, q_signs);
    put_lone_corner_first(q, q_signs, p, p_signs);
    const int first = orientation(p[0], p[1], q[0], q[1]);
    const int second = orientation(p[0], p[2], q[2], q[0]);
    if (first > 0 || second > 0)
        return std::nullopt;
    const bool segment = first < 0 && second < 0 && !in_a_point(p_signs) && !in_a_point(q_signs);
    if (!segment && share_a_corner)
        return std::nullopt;
    return segment && both_sides(p_signs) && both_sides(q_signs) ? IntersectionKind::crossing
                                                                 : IntersectionKind::touching;
}

bool all_outside(const Flat& edges_of, const Flat& corners, bool strictly) noexcept {
    for (std::size_t k = 0; k < 3; ++k) {
        const auto outside = [&](const Point2& p) {
            const int side = orientation(edges_of[k], edges_of[(k + 1) % 3], p);
            return strictly ? side < 0 : side <= 0;
        };
        if (std::all_of(corners.begin(), corners.end(), outside))
            return true;
    }
    return false;
}

/// Returns whether an edge of each triangle leads in the same direction from a common corner.
bool edges_together(const Flat& p, std::size_t at_p, const Flat& q, std::size_t at_q) noexcept {
    const Point2& o = p[at_p];
    for (std::size_t i = 1; i < 3; ++i)
        for (std::size_t j = 1; j < 3; ++j) {
            const Point2& a = p[(at_p + i) % 3];
            const Point2& b = q[(at_q + j) % 3];
            const bool same_way =
                a.x != o.x ? (a.x > o.x) == (b.x > o.x) && b.x != o.x : (a.y > o.y) == (b.y > o.y);
            if (same_way && orientation(o, a, b) == 0)
                return true;
        }
    return false;
}

struct Shared {
    int count = 0;
    std::size_t at_p = 0; ///< index of the last one found
    std::size_t at_q = 0;
};

Shared shared_corners(const NamedTriangle& p, const NamedTriangle& q) noexcept {
    Shared shared;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (p.names[i] == q.names[j])
                shared = {shared.count + 1, i, j};
    return shared;
}

std::optional<IntersectionKind> contact_in_a_plane(const Triangle3& p, const Triangle3& q,
                                                   const Shared& shared) noexcept {
    // Any projection in which p has an area is suitable; the axis of the largest component of its normal is
    // safest.
    const Point3 n = normal(p);
    const std::array<double, 3> sizes{std::abs(n.x), std::abs(n.y), std::abs(n.z)};
    int axis = static_cast<int>(std::max_element(sizes.begin(), sizes.end()) - sizes.begin());
    const auto area_sign = [&](const Triangle3& t) {
        const Flat f = projected(t, axis);
        return orientation(f[0], f[1], f[2]);
    };
    for (int tries = 0; tries < 2 && area_sign(p) == 0; ++tries)
        axis = (axis + 1) % 3;
    Flat fp = projected(p, axis);
    Flat fq = projected(q, axis);
    std::size_t at_p = shared.at_p;
    std::size_t at_q = shared.at_q;
    const auto turn = [](Flat& f, std::size_t& at) {
        std::swap(f[1], f[2]);
        at = at == 0 ? 0 : 3 - at;
    };
    if (area_sign(p) < 0)
        turn(fp, at_p);
    if (area_sign(q) < 0)
        turn(fq, at_q);
    if (!all_outside(fp, fq, false) && !all_outside(fq, fp, false))
        return IntersectionKind::overlapping;
    // The triangles lie on different sides of a line and can meet only on it. If they share a corner there,
    // they have more in common only if two edges lead from it in the same direction.
    const bool touch = shared.count == 0 ? !all_outside(fp, fq, true) && !all_outside(fq, fp, true)
                                         : shared.count == 1 && edges_together(fp, at_p, fq, at_q);
    return touch ? std::optional(IntersectionKind::touching) : std::nullopt;
}

} // namespace

bool flat(const Triangle3& t) noexcept {
    for (int axis = 0; axis < 3; ++axis) {
        const Flat f = projected(t, axis);
        if (orientation(f[0], f[1], f[2]) != 0)
            return false;
    }
    return true;
}

// Triangles in different planes follow Guigue and Devillers (2003). The corner of each triangle that is alone
// on its side of the other's plane comes first. Each triangle then intersects the common line of both planes
// in an interval. The ends of the intervals are compared by orientations of four corners.
std::optional<IntersectionKind> ContactSeeker::with_close_one(const NamedTriangle& other) const noexcept {
    const Shared shared = shared_corners(triangle_, other);
    if (shared.count >= 3)
        return IntersectionKind::overlapping;
    const auto signs_by = [](const NamedTriangle& of_plane, const TrianglePlane& plane,
                             const NamedTriangle& of) {
        Signs signs{};
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t name = of.names[k];
            const bool shared_corner =
                name == of_plane.names[0] || name == of_plane.names[1] || name == of_plane.names[2];
            signs[k] = shared_corner ? 0 : plane.side(of.corners[k]);
        }
        return signs;
    };
    const Signs other_signs = signs_by(triangle_, plane_, other);
    if (same(other_signs, 1) || same(other_signs, -1))
        return std::nullopt;
    if (same(other_signs, 0))
        return contact_in_a_plane(triangle_.corners, other.corners, shared);
    const bool share_a_corner = shared.count == 1;
    if (shared.count == 2 || (share_a_corner && in_a_point(other_signs)))
        return std::nullopt;
    const TrianglePlane other_plane(other.corners[0], other.corners[1], other.corners[2]);
    const Signs signs = signs_by(other, other_plane, triangle_);
    if (same(signs, 1) || same(signs, -1) || (share_a_corner && in_a_point(signs)))
        return std::nullopt;
    return contact_in_a_line(triangle_.corners, other.corners, signs, other_signs, share_a_corner);
}

Point3 contact_point(const Triangle3& p, const Triangle3& q, IntersectionKind kind) noexcept {
    if (kind == IntersectionKind::crossing) {
        // The edges of each triangle intersect the plane of the other in four points on a line; the middle
        // two are the ends of the intersection.
        std::array<Point3, 4> ends;
        std::size_t n = 0;
        const auto add_ends = [&](const Triangle3& t, const Triangle3& plane) {
            const Point3 up = normal(plane);
            const auto height = [&](const Point3& x) {
                return up.x * (x.x - plane[0].x) + up.y * (x.y - plane[0].y) + up.z * (x.z - plane[0].z);
            };
            for (std::size_t k = 0; k < 3 && n < 4; ++k) {
                const Point3& a = t[k];
                const Point3& b = t[(k + 1) % 3];
                const double from = height(a);
                const double to = height(b);
                if ((from > 0) == (to > 0))
                    continue;
                const double s = from / (from - to);
                ends[n++] = {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z)};
            }
        };
        add_ends(p, q);
        if (n == 2)
            add_ends(q, p);
        if (n == 4) {
            std::sort(ends.begin(), ends.end());
            return {(ends[1].x + ends[2].x) / 2, (ends[1].y + ends[2].y) / 2, (ends[1].z + ends[2].z) / 2};
        }
    }
    Box3 box_p;
    Box3 box_q;
    for (std::size_t k = 0; k < 3; ++k) {
        box_p.add(p[k]);
        box_q.add(q[k]);
    }
    const auto middle = [](double low_a, double high_a, double low_b, double high_b) {
        return std::max(low_a, low_b) / 2 + std::min(high_a, high_b) / 2;
    };
    return {middle(box_p.min.x, box_p.max.x, box_q.min.x, box_q.max.x),
            middle(box_p.min.y, box_p.max.y, box_q.min.y, box_q.max.y),
            middle(box_p.min.z, box_p.max.z, box_q.min.z, box_q.max.z)};
}

} // namespace lamella
