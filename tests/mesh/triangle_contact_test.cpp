#include "fixtures/random.hpp"
#include "mesh/triangle_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

namespace lamella {
namespace {

using test::Random;
__extension__ using Wide = __int128;

// The same question for small whole numbers, answered another way: the vertices of what two triangles have in
// common are among corners within the other and places where an edge meets the other triangle's plane or one
// of its edges. All of them are rational numbers, so they can be told apart exactly.

struct Whole {
    std::int64_t x;
    std::int64_t y;
    std::int64_t z;
};

Whole operator-(const Whole& a, const Whole& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
Whole cross(const Whole& a, const Whole& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
std::int64_t dot(const Whole& a, const Whole& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// A point whose coordinates are fractions with one positive denominator.
struct Fraction {
    std::array<std::int64_t, 4> v;

    static Fraction of(const Whole& numerator, std::int64_t denominator) {
        std::int64_t g = std::gcd(std::gcd(numerator.x, numerator.y), std::gcd(numerator.z, denominator));
        if (denominator < 0)
            g = -g;
        return {{numerator.x / g, numerator.y / g, numerator.z / g, denominator / g}};
    }
    friend std::strong_ordering operator<=>(const Fraction&, const Fraction&) = default;
};

using WholeTriangle = std::array<Whole, 3>;

Whole normal(const WholeTriangle& t) {
    return cross(t[1] - t[0], t[2] - t[0]);
}

/// Whether a point of the triangle's plane lies within it or on its edge.
bool within(const Fraction& p, const WholeTriangle& t) {
    const Whole n = normal(t);
    for (std::size_t k = 0; k < 3; ++k) {
        const Whole& a = t[k];
        const Whole& b = t[(k + 1) % 3];
        const Whole w{p.v[0] - a.x * p.v[3], p.v[1] - a.y * p.v[3], p.v[2] - a.z * p.v[3]};
        const Whole side = cross(b - a, w);
        if (Wide{side.x} * n.x + Wide{side.y} * n.y + Wide{side.z} * n.z < 0)
            return false;
    }
    return true;
}

/// Where edges and corners of p meet q.
void add_common(const WholeTriangle& p, const WholeTriangle& q, std::set<Fraction>& common) {
    const Whole n = normal(q);
    for (std::size_t k = 0; k < 3; ++k) {
        const Whole& a = p[k];
        const Whole& b = p[(k + 1) % 3];
        const std::int64_t da = dot(n, a - q[0]);
        const std::int64_t db = dot(n, b - q[0]);
        if (da == 0 && within(Fraction::of(a, 1), q))
            common.insert(Fraction::of(a, 1));
        if ((da < 0 && db > 0) || (da > 0 && db < 0)) {
            const std::int64_t w = da - db;
            const Fraction at = Fraction::of(
                {a.x * w + da * (b.x - a.x), a.y * w + da * (b.y - a.y), a.z * w + da * (b.z - a.z)}, w);
            if (within(at, q))
                common.insert(at);
        }
        if (da == 0 && db == 0)
            for (std::size_t j = 0; j < 3; ++j) { // in the plane: with each edge of q
                const Whole& c = q[j];
                const Whole& d = q[(j + 1) % 3];
                const Whole u = b - a;
                const Whole v = d - c;
                const Whole uv = cross(u, v);
                const std::int64_t square = dot(uv, uv);
                if (square == 0)
                    continue;
                const std::int64_t s = dot(cross(c - a, v), uv);
                const std::int64_t t = dot(cross(c - a, u), uv);
                if (s >= 0 && s <= square && t >= 0 && t <= square)
                    common.insert(Fraction::of(
                        {a.x * square + s * u.x, a.y * square + s * u.y, a.z * square + s * u.z}, square));
            }
    }
}

std::size_t dimension(const std::set<Fraction>& points) {
    if (points.size() < 2)
        return points.size(); // one more than the dimension
    const std::vector<Fraction> p(points.begin(), points.end());
    const auto gap = [&](std::size_t i) -> std::array<Wide, 3> {
        return {Wide{p[i].v[0]} * p[0].v[3] - Wide{p[0].v[0]} * p[i].v[3],
                Wide{p[i].v[1]} * p[0].v[3] - Wide{p[0].v[1]} * p[i].v[3],
                Wide{p[i].v[2]} * p[0].v[3] - Wide{p[0].v[2]} * p[i].v[3]};
    };
    const auto u = gap(1);
    for (std::size_t i = 2; i < p.size(); ++i) {
        const auto v = gap(i);
        if (u[0] * v[1] != u[1] * v[0] || u[1] * v[2] != u[2] * v[1] || u[2] * v[0] != u[0] * v[2])
            return 3;
    }
    return 2;
}

std::optional<IntersectionKind> naive_contact(const WholeTriangle& p,
                                              const std::array<std::uint32_t, 3>& p_names,
                                              const WholeTriangle& q,
                                              const std::array<std::uint32_t, 3>& q_names) {
    std::set<Fraction> common;
    add_common(p, q, common);
    add_common(q, p, common);
    std::set<Fraction> shared;
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            if (p_names[i] == q_names[j])
                shared.insert(Fraction::of(p[i], 1));
    // What is common is convex: a point, a segment, an area. A shared vertex or edge is all of it or not.
    const std::size_t d = dimension(common);
    if (d == 3)
        return IntersectionKind::overlapping;
    if (d == shared.size())
        return std::nullopt;
    const auto both_sides = [](const WholeTriangle& plane, const WholeTriangle& t) {
        int least = 0;
        int most = 0;
        for (const Whole& corner : t) {
            const std::int64_t side = dot(normal(plane), corner - plane[0]);
            least = std::min(least, static_cast<int>(side < 0) * -1);
            most = std::max(most, static_cast<int>(side > 0));
        }
        return least < 0 && most > 0;
    };
    return d == 2 && both_sides(p, q) && both_sides(q, p) ? IntersectionKind::crossing
                                                          : IntersectionKind::touching;
}

Triangle3 real(const WholeTriangle& t) {
    Triangle3 out;
    for (std::size_t k = 0; k < 3; ++k)
        out[k] = {static_cast<double>(t[k].x), static_cast<double>(t[k].y), static_cast<double>(t[k].z)};
    return out;
}

TEST(TriangleContact, AgreesWithExactFractionsOnSmallGridsHoweverTheCornersStand) {
    Random random(11);
    std::array<std::size_t, 4> seen{};
    for (int round = 0; round < 60000; ++round) {
        const std::int64_t cells = 1 + round % 5;
        const bool in_plane = round % 7 == 0;
        std::vector<Whole> points;
        for (int k = 0; k < 6; ++k) {
            Whole w{random.integer(0, cells), random.integer(0, cells), random.integer(0, cells)};
            if (in_plane)
                w.z = w.x + 2 * w.y;
            points.push_back(w);
        }
        std::array<std::uint32_t, 3> p_names{0, 1, 2};
        std::array<std::uint32_t, 3> q_names{3, 4, 5};
        const auto shared = static_cast<std::uint32_t>(random.integer(0, 3));
        for (std::uint32_t k = 0; k < shared; ++k)
            q_names[k] = k;
        const auto turn = [&](std::array<std::uint32_t, 3>& names) {
            std::rotate(names.begin(), names.begin() + random.integer(0, 2), names.end());
            if (random.integer(0, 1) == 1)
                std::swap(names[0], names[1]);
        };
        turn(p_names);
        turn(q_names);
        const WholeTriangle p{points[p_names[0]], points[p_names[1]], points[p_names[2]]};
        const WholeTriangle q{points[q_names[0]], points[q_names[1]], points[q_names[2]]};
        ASSERT_EQ(flat(real(p)), dot(normal(p), normal(p)) == 0);
        if (flat(real(p)) || flat(real(q)))
            continue;
        const std::optional<IntersectionKind> expected = naive_contact(p, p_names, q, q_names);
        ++seen[expected ? static_cast<std::size_t>(*expected) : 3];
        ASSERT_EQ(contact({real(p), p_names}, {real(q), q_names}), expected) << "round " << round;
        ASSERT_EQ(contact({real(q), q_names}, {real(p), p_names}), expected) << "round " << round;
    }
    for (const std::size_t count : seen)
        EXPECT_GT(count, 1000U); // every answer did occur
}

TEST(TriangleContact, DoesNotChangeWhereCoordinatesAreHuge) {
    Random random(12);
    for (int round = 0; round < 3000; ++round) {
        std::array<Triangle3, 2> t;
        for (Triangle3& triangle : t)
            for (Point3& p : triangle)
                p = {static_cast<double>(random.integer(0, 4)), static_cast<double>(random.integer(0, 4)),
                     static_cast<double>(random.integer(0, 4))};
        if (flat(t[0]) || flat(t[1]))
            continue;
        std::array<Triangle3, 2> huge = t;
        for (Triangle3& triangle : huge)
            for (Point3& p : triangle)
                p = {p.x * 0x1p1020, p.y * 0x1p1020, p.z * 0x1p1020};
        EXPECT_EQ(contact({t[0], {0, 1, 2}}, {t[1], {3, 4, 5}}),
                  contact({huge[0], {0, 1, 2}}, {huge[1], {3, 4, 5}}));
    }
}

TEST(TriangleContact, ThePlaceOfACrossingIsOnBoth) {
    const Triangle3 floor{{{-4, -4, 0}, {4, -4, 0}, {0, 8, 0}}};
    const Triangle3 blade{{{-1, 0, -1}, {1, 0, -1}, {0, 0, 1}}};
    ASSERT_EQ(contact({floor, {0, 1, 2}}, {blade, {3, 4, 5}}), IntersectionKind::crossing);
    const Point3 at = contact_point(floor, blade, IntersectionKind::crossing);
    EXPECT_NEAR(at.x, 0, 1e-12);
    EXPECT_NEAR(at.y, 0, 1e-12);
    EXPECT_NEAR(at.z, 0, 1e-12);
}

} // namespace
} // namespace lamella
