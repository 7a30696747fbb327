#include "lamella/contour/measure.hpp"
#include "lamella/polygon/crossings.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/orientation.hpp"
#include "polygon/simple_polygons.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>
#include <vector>

namespace lamella::simple_polygons_cases {
namespace {

using test::Contour;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::reversed;

/// Returns how many points two closed segments have in common: 0, 1, or 2 if they share more than a point.
int points_in_common(const Point2& a, const Point2& b, const Point2& c, const Point2& d) {
    std::set<Point2> common;
    const auto on = [](const Point2& p, const Point2& q, const Point2& r) {
        return orientation(p, q, r) == 0 && std::min(p, q) <= r && r <= std::max(p, q);
    };
    for (const Point2& p : {c, d})
        if (on(a, b, p))
            common.insert(p);
    for (const Point2& p : {a, b})
        if (on(c, d, p))
            common.insert(p);
    if (common.empty() && orientation(a, b, c) * orientation(a, b, d) < 0 &&
        orientation(c, d, a) * orientation(c, d, b) < 0)
        return 2; // a crossing is as wrong
    return static_cast<int>(common.size());
}

/// Checks the rules of the standard, side by side, and returns the area.
double expect_simple(const std::vector<SimplePolygon>& polygons) {
    std::vector<Ring> rings;
    double area = 0;
    for (const SimplePolygon& polygon : polygons) {
        EXPECT_GT(ring_area(polygon.outer), 0);
        rings.push_back(polygon.outer);
        for (const Ring& hole : polygon.holes) {
            EXPECT_LT(ring_area(hole), 0);
            rings.push_back(hole);
        }
    }
    for (const Ring& ring : rings) {
        area += ring_area(ring);
        EXPECT_EQ(std::set<Point2>(ring.begin(), ring.end()).size(), ring.size());
        for (const Point2& p : ring)
            EXPECT_TRUE(p.x == std::nearbyint(p.x) && p.y == std::nearbyint(p.y));
    }
    for (std::size_t r = 0; r < rings.size(); ++r)
        for (std::size_t s = r; s < rings.size(); ++s)
            for (std::size_t i = 0; i < rings[r].size(); ++i)
                for (std::size_t k = 0; k < rings[s].size(); ++k) {
                    if (r == s && i >= k)
                        continue;
                    const Ring& one = rings[r];
                    const Ring& other = rings[s];
                    EXPECT_LT(points_in_common(one[i], one[(i + 1) % one.size()], other[k],
                                               other[(k + 1) % other.size()]),
                              2);
                }
    return area;
}

TEST(SimplePolygons, UniteBodiesBackToBack) {
    const auto polygons = simple_polygons(normal_layer({rectangle(0, 0, 10, 10), rectangle(10, 2, 20, 12)}));
    EXPECT_EQ(polygons.size(), 1U);
    EXPECT_EQ(expect_simple(polygons), 200);
}

TEST(SimplePolygons, DivideARingThatTouchesItself) {
    // A square with a hole that hangs at a corner of its outline, drawn as one ring.
    const Contour ring{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 5}, {4, 7}, {4, 3}, {0, 5}};
    const auto polygons = simple_polygons(normal_layer({ring}));
    ASSERT_EQ(polygons.size(), 1U);
    EXPECT_EQ(polygons.front().holes.size(), 1U);
    EXPECT_EQ(expect_simple(polygons), 92);
}

TEST(SimplePolygons, DivideABodyWhoseHoleReachesFromSideToSide) {
    const Contour hole{{0, 5}, {5, 8}, {10, 5}, {5, 2}}; // clockwise
    const auto polygons = simple_polygons(normal_layer({rectangle(0, 0, 10, 10), hole}));
    EXPECT_EQ(polygons.size(), 2U);
    EXPECT_EQ(expect_simple(polygons), 70);
}

TEST(SimplePolygons, AreValidAndHaveTheAreaOfTheMaterialForRandomRings) {
    Random random(61);
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        std::vector<Contour> rings;
        for (std::int64_t count = random.integer(1, 7); count > 0; --count) {
            Contour ring;
            const std::int64_t most = round % 2 == 0 ? 8 : 100'000;
            for (std::int64_t points = random.integer(3, 7); points > 0; --points)
                ring.push_back({static_cast<double>(random.integer(0, most)),
                                static_cast<double>(random.integer(0, most))});
            rings.push_back(random.integer(0, 1) == 0 ? ring : reversed(ring));
        }
        const Layer layer = normal_layer(rings);
        const double area = expect_simple(simple_polygons(layer));
        if (round % 2 != 0) { // where the unit is small compared with the sides
            EXPECT_NEAR(area, test::winding_area(layer, [](int winding) { return winding > 0; }),
                        2 * measure(layer).perimeter_mm);
        }
    }
}

} // namespace
} // namespace lamella::simple_polygons_cases
