#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"
#include "slicing/sweep/pairing.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using pairing::Ray;
using test::Triangles;

/// Rays around an edge as brackets: '(' leaves and opens a wedge, ')' arrives and closes one.
std::vector<std::pair<std::size_t, std::size_t>> matched(std::string_view brackets) {
    std::vector<Ray> rays;
    for (const char c : brackets)
        rays.push_back({c == ')', 0, {}, 0, 0});
    std::vector<std::pair<std::size_t, std::size_t>> pairs = pairing::match(rays);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;

TEST(Match, PairsAnArrivalWithTheNearestOpenWedge) {
    EXPECT_EQ(matched("()"), (Pairs{{1, 0}}));
    EXPECT_EQ(matched("()()"), (Pairs{{1, 0}, {3, 2}}));
    EXPECT_EQ(matched("(())"), (Pairs{{2, 1}, {3, 0}}));
    EXPECT_EQ(matched("()(())"), (Pairs{{1, 0}, {4, 3}, {5, 2}}));
}

TEST(Match, GoesOnceMoreAroundForWedgesAcrossTheAngleZero) {
    EXPECT_EQ(matched(")("), (Pairs{{0, 1}}));
    EXPECT_EQ(matched(")()("), (Pairs{{0, 3}, {2, 1}}));
    EXPECT_EQ(matched("))(("), (Pairs{{0, 3}, {1, 2}}));
    EXPECT_EQ(matched(")(()"), (Pairs{{0, 1}, {3, 2}}));
}

TEST(Match, DoesNotDependOnWhereTheTurnBegins) {
    const std::string brackets = "(()())(())()";
    const std::size_t n = brackets.size();
    const Pairs expected = matched(brackets);
    for (std::size_t shift = 1; shift < n; ++shift) {
        Pairs pairs = matched(brackets.substr(shift) + brackets.substr(0, shift));
        for (auto& [arriving, leaving] : pairs) {
            arriving = (arriving + shift) % n;
            leaving = (leaving + shift) % n;
        }
        std::sort(pairs.begin(), pairs.end());
        EXPECT_EQ(pairs, expected) << shift;
    }
}

TEST(Match, LeavesOverWhatHasNoPartner) {
    EXPECT_EQ(matched(""), Pairs{});
    EXPECT_EQ(matched("(("), Pairs{});
    EXPECT_EQ(matched("))"), Pairs{});
    EXPECT_EQ(matched("(()"), (Pairs{{2, 1}}));
    EXPECT_EQ(matched("())"), (Pairs{{1, 0}}));
    EXPECT_EQ(matched(")))("), (Pairs{{0, 3}}));
}

TEST(RayAngle, GrowsWithTheTrueAngle) {
    const Point3 low{1, 2, 0};
    const Point3 high{1, 2, 5};
    float before = 0;
    for (int degrees = 0; degrees < 360; ++degrees) {
        const double angle = degrees * std::numbers::pi / 180;
        const float here =
            pairing::ray_angle(low, high, {1 + 7 * std::cos(angle), 2 + 7 * std::sin(angle), 3});
        EXPECT_GT(here, before) << degrees;
        EXPECT_GE(here, 4.0F);
        EXPECT_LT(here, 8.0F);
        before = here;
    }
}

TEST(RayAngle, OfAPlaneThroughTheEdgeIsTheSameWhereverTheThirdCornerIs) {
    const Point3 low{0, 0, 0};
    const Point3 high{1, -2, 4}; // leaning
    const float expected = pairing::ray_angle(low, high, {3, 5, 0});
    for (const double along : {-3.0, -0.5, 0.25, 2.0, 10.0})
        for (const double away : {0.125, 1.0, 64.0})
            EXPECT_EQ(pairing::ray_angle(low, high, {3 * away + along, 5 * away - 2 * along, 4 * along}),
                      expected);
}

TEST(RayAngle, OfACornerOnTheEdgeIsTheFirst) {
    EXPECT_EQ(pairing::ray_angle({0, 0, 0}, {1, 1, 1}, {2, 2, 2}), 4.0F);
}

// Rounding errors on either side of the angle where a turn begins and ends.
TEST(RayAngle, OfAPlaneAlongTheXAxisIsTheFirst) {
    const Point3 low{0, 0, 0};
    const Point3 high{0, 0, 1};
    for (const double error : {-1e-16, -0.0, 0.0, 1e-16})
        EXPECT_EQ(pairing::ray_angle(low, high, {1, error, 0.5}), 4.0F) << error;
}

TEST(RayAngle, IsTheSameInAnyUnit) {
    const Point3 low{1, -2, 0.5};
    const Point3 high{-3, 1, 4};
    const Point3 third{-5, 7, -6};
    const float expected = pairing::ray_angle(low, high, third);
    const auto scaled = [](const Point3& p, double unit, double unit_z) {
        return Point3{p.x * unit, p.y * unit, p.z * unit_z};
    };
    // From the smallest to the largest numbers that leave every coordinate its digits.
    for (const double unit : {0x1p-1000, 0x1p-530, 1.0, 0x1p511, 0x1p520, 0x1p1000, 0x1p1020})
        for (const double unit_z : {0x1p-1000, 1.0, 0x1p1000})
            EXPECT_EQ(pairing::ray_angle(scaled(low, unit, unit_z), scaled(high, unit, unit_z),
                                         scaled(third, unit, unit_z)),
                      expected)
                << unit << ", heights " << unit_z;
}

TEST(RayAngle, IsANumberWhereDifferencesOverflow) {
    constexpr double most = std::numeric_limits<double>::max();
    const float angle = pairing::ray_angle({-most, -most, -most}, {most, most, most}, {most, -most, 0});
    EXPECT_GE(angle, 4.0F);
    EXPECT_LT(angle, 8.0F);
}

Layer section(const Triangles& triangles, double z = 0.5) {
    return slice(test::soup(triangles), plan_listed({z})).front();
}

/// Areas of the rings, in ascending order.
std::vector<double> areas(const Layer& layer) {
    std::vector<double> out;
    for (std::size_t i = 0; i < layer.rings; ++i)
        out.push_back(ring_area(layer.contour(i)));
    std::sort(out.begin(), out.end());
    return out;
}

void expect_areas(const Triangles& triangles, const std::vector<double>& expected) {
    const Layer layer = section(triangles);
    EXPECT_EQ(layer.open_chains(), 0U);
    const std::vector<double> found = areas(layer);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i)
        EXPECT_NEAR(found[i], expected[i], 1e-6);
    for (std::uint64_t seed = 0; seed < 20; ++seed)
        EXPECT_TRUE(
            same_contours(slice(shuffled(test::soup(triangles), seed), plan_listed({0.5})).front(), layer))
            << "the order of the triangles shows, seed " << seed;
}

/// Turned about the z axis, all bodies alike: coordinates are rounded alike too, so shared corners stay so.
Triangles turned(const Triangles& triangles, double degrees) {
    const double c = std::cos(degrees * std::numbers::pi / 180);
    const double s = std::sin(degrees * std::numbers::pi / 180);
    Triangles out = triangles;
    for (Triangle3f& t : out)
        for (Point3f& p : t)
            p = {static_cast<float>(c * p.x - s * p.y), static_cast<float>(s * p.x + c * p.y), p.z};
    return out;
}

/// Upright triangular prism with its sharp edge on the z axis, between two directions.
Triangles wedge(double from_degrees, double to_degrees, float radius = 1) {
    const auto at = [&](double degrees, float z) -> Point3f {
        const double angle = std::fmod(degrees, 360) * std::numbers::pi / 180;
        return {static_cast<float>(radius * std::cos(angle)), static_cast<float>(radius * std::sin(angle)),
                z};
    };
    const Point3f o{0, 0, 0};
    const Point3f a = at(from_degrees, 0);
    const Point3f b = at(to_degrees, 0);
    const Point3f o1{0, 0, 1};
    const Point3f a1 = at(from_degrees, 1);
    const Point3f b1 = at(to_degrees, 1);
    Triangles out{{o, b, a}, {o1, a1, b1}};
    test::add_quad(out, o, a, a1, o1);
    test::add_quad(out, a, b, b1, a1);
    test::add_quad(out, b, o, o1, b1);
    return out;
}

double wedge_area(double degrees) {
    return std::sin(degrees * std::numbers::pi / 180) / 2;
}

TEST(EdgePairing, KeepsTwoBodiesThatTouchInAnEdgeApart) {
    expect_areas(
        test::joined({test::box_triangles({0, 0, 0}, {1, 1, 1}), test::box_triangles({1, 1, 0}, {2, 3, 1})}),
        {1, 2});
    for (int degrees = 0; degrees < 360; degrees += 15)
        expect_areas(turned(test::joined({wedge(10, 60), wedge(100, 170)}), degrees),
                     {wedge_area(50), wedge_area(70)});
}

TEST(EdgePairing, KeepsAnyNumberOfWedgesApart) {
    for (int degrees = 0; degrees < 360; degrees += 15)
        expect_areas(turned(test::joined({wedge(0, 30), wedge(50, 90), wedge(130, 180), wedge(200, 260),
                                          wedge(270, 340)}),
                            degrees),
                     {wedge_area(30), wedge_area(40), wedge_area(50), wedge_area(60), wedge_area(70)});
}

TEST(EdgePairing, KeepsBodiesWithACommonFaceApart) {
    expect_areas(
        test::joined({test::box_triangles({0, 0, 0}, {1, 1, 1}), test::box_triangles({1, 0, 0}, {3, 1, 1})}),
        {1, 2});
    expect_areas(
        test::joined({test::box_triangles({0, 0, 0}, {1, 1, 1}), test::box_triangles({0, -2, 0}, {1, 0, 1})}),
        {1, 2});
    for (int degrees = 0; degrees < 360; degrees += 15)
        expect_areas(turned(test::joined({wedge(0, 40), wedge(40, 90)}), degrees),
                     {wedge_area(40), wedge_area(50)});
}

/// A box 10 wide and high, with a corner in the middle of one of its faces across y.
Triangles box_with_fan(float y0, float y1, bool on_lower, const Point3f& middle) {
    Triangles triangles;
    const float face = on_lower ? y0 : y1;
    for (const Triangle3f& t : test::box_triangles({0, y0, 0}, {10, y1, 10}))
        if (t[0].y != face || t[1].y != face || t[2].y != face)
            triangles.push_back(t);
    const std::array<Point3f, 4> corners{Point3f{0, face, 0}, Point3f{10, face, 0}, Point3f{10, face, 10},
                                         Point3f{0, face, 10}};
    for (std::size_t k = 0; k < 4; ++k) {
        const Point3f& a = corners[k];
        const Point3f& b = corners[(k + 1) % 4];
        triangles.push_back(on_lower ? Triangle3f{a, b, middle} : Triangle3f{b, a, middle});
    }
    return triangles;
}

// Each body has triangles of its own on the common face: rays in one direction are computed from different
// corners, and differ by roundings, also where the turn begins.
TEST(EdgePairing, KeepsBodiesApartWhoseCommonFaceHasOtherTriangles) {
    const Triangles one = box_with_fan(0, 5, true, {4, 0, 3.7F});
    const Triangles other = box_with_fan(-5, 0, false, {6, 0, 6.1F});
    for (const double about_z : {0.0, 90.0, 180.0, 270.0})
        for (int about_x = 1; about_x < 90; about_x += 4) {
            const Transform turn = compose(rotation('z', about_z), rotation('x', about_x));
            const auto placed = [&](const Triangles& triangles) {
                return Mesh(test::soup(triangles).transformed(turn));
            };
            const Mesh both = placed(test::joined({one, other}));
            const Box3 box = bounding_box(both);
            const Plan plan = plan_uniform(box.min.z, box.max.z, {.layer_height = 0.5});
            const LayerStack layers = slice(both, plan);
            const LayerStack of_one = slice(placed(one), plan);
            const LayerStack of_other = slice(placed(other), plan);
            for (std::size_t i = 0; i < layers.size(); ++i) {
                EXPECT_EQ(layers[i].rings, of_one[i].rings + of_other[i].rings)
                    << about_x << ", " << about_z << ", layer " << i;
                EXPECT_EQ(layers[i].open_chains(), 0U);
            }
        }
}

TEST(EdgePairing, KeepsBodiesAroundAnEdgeApartThatLeaveNoGap) {
    for (int degrees = 0; degrees < 360; degrees += 5)
        expect_areas(
            turned(test::joined({wedge(0, 90), wedge(90, 200), wedge(200, 300), wedge(300, 360)}), degrees),
            {wedge_area(60), wedge_area(110), wedge_area(100), wedge_area(90)});
}

TEST(EdgePairing, LinksEveryCopyOfABodyToItself) {
    const Triangles body = test::box_triangles({0, 0, 0}, {1, 1, 1});
    expect_areas(test::joined({body, body}), {1, 1});
    expect_areas(test::joined({body, body, body, body}), {1, 1, 1, 1});
    for (int degrees = 0; degrees < 360; degrees += 30)
        expect_areas(turned(test::joined({wedge(20, 60), wedge(20, 60), wedge(20, 60)}), degrees),
                     {wedge_area(40), wedge_area(40), wedge_area(40)});
}

TEST(EdgePairing, CancelsABodyAndItsOppositeOnlyInArea) {
    const Triangles body = test::box_triangles({0, 0, 0}, {1, 1, 1});
    const Layer layer = section(test::joined({body, test::flipped(body)}));
    EXPECT_EQ(layer.open_chains(), 0U);
    EXPECT_EQ(measure(layer).area_mm2, 0.0);
}

TEST(EdgePairing, ClosesEveryContourOfBodiesThatOverlapAtAnEdge) {
    const auto total = [](const Triangles& triangles, double expected) {
        const Layer layer = section(triangles);
        EXPECT_EQ(layer.open_chains(), 0U);
        EXPECT_NEAR(measure(layer).area_mm2, expected, 1e-6);
        for (std::uint64_t seed = 0; seed < 10; ++seed)
            EXPECT_TRUE(same_contours(
                slice(shuffled(test::soup(triangles), seed), plan_listed({0.5})).front(), layer));
    };
    total(test::joined({wedge(0, 90), wedge(30, 60)}), wedge_area(90) + wedge_area(30));
    total(test::joined({wedge(0, 60), wedge(30, 90)}), 2 * wedge_area(60));
    total(
        test::joined({test::box_triangles({0, 0, 0}, {1, 1, 1}), test::box_triangles({0, 0, 0}, {2, 2, 1})}),
        5);
    total(test::joined({test::box_triangles({0, 0, 0}, {2, 2, 1}),
                        test::flipped(test::box_triangles({0, 0, 0}, {1, 1, 1}))}),
          3);
    total(test::joined({wedge(0, 90), wedge(0, 90, 2), wedge(0, 30)}), 0.5 + 2 + wedge_area(30));
}

TEST(EdgePairing, LeavesAChainForARayWithoutPartner) {
    // A sheet of one wall stands on the edge of a box: its edge has three triangles.
    Triangles triangles = test::box_triangles({0, 0, 0}, {1, 1, 1});
    test::add_quad(triangles, {1, 1, 0}, {2, 2, 0}, {2, 2, 1}, {1, 1, 1});
    const Layer layer = section(triangles);
    EXPECT_EQ(layer.rings, 1U);
    EXPECT_EQ(layer.open_chains(), 1U);
    for (std::uint64_t seed = 0; seed < 20; ++seed)
        EXPECT_TRUE(
            same_contours(slice(shuffled(test::soup(triangles), seed), plan_listed({0.5})).front(), layer));
}

TEST(EdgePairing, WorksOnEdgesOfAnySize) {
    const Triangles bodies = test::joined({wedge(10, 60), wedge(100, 170), wedge(200, 290)});
    const Layer expected = section(bodies);
    ASSERT_EQ(expected.rings, 3U);
    for (const double unit : {1e-140, 1e-30, 1e30, 1e98}) {
        IndexedMesh mesh = test::indexed(bodies);
        for (Point3& p : mesh.vertices)
            p = {p.x * unit, p.y * unit, p.z * unit};
        const Layer layer = slice(mesh, plan_listed({0.5 * unit}, SliceAt::middle, unit)).front();
        EXPECT_EQ(layer.rings, 3U) << unit;
        EXPECT_EQ(layer.open_chains(), 0U) << unit;
    }
}

} // namespace
} // namespace lamella
