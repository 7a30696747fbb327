#include "lamella/contour/measure.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/layers.hpp"
#include "scan/narrow_bodies.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace lamella::narrow_bodies_cases {
namespace {

using test::Contour;
using test::normal_layer;
using test::rectangle;
using test::regular_polygon;
using test::reversed;

Layer narrow_bodies(const Layer& layer) {
    return bodies_by_width(layer, offset(layer, -0.15), 0.15).narrow;
}

TEST(BodiesByWidth, AreNoneThatAreNarrowWhereAllIsWide) {
    for (const Contour& ring : {rectangle(0, 0, 10, 10), regular_polygon(300, 5), regular_polygon(5, 2)})
        EXPECT_EQ(narrow_bodies(normal_layer({ring})).rings, 0U);
    const Layer plate = normal_layer({rectangle(0, 0, 10, 10), reversed(regular_polygon(40, 1))});
    EXPECT_EQ(narrow_bodies(plate).rings, 0U);
}

// A sharp corner has sides parallel to those of its inset, too.
TEST(BodiesByWidth, AreNarrowWithThinWallsOrSharpCorners) {
    const Contour plate = rectangle(0, 0, 10, 10);
    const Contour wall = rectangle(20, 0, 20.29, 10);
    const Contour wedge{{30, 0}, {40, 0}, {30, 5}};
    const Layer bodies = narrow_bodies(normal_layer({plate, wall, wedge, reversed(rectangle(2, 2, 4, 4))}));
    ASSERT_EQ(bodies.rings, 2U);
    EXPECT_EQ(bodies.contour(0).front().x, 20);
    EXPECT_EQ(bodies.contour(1).front().x, 30);
    const Layer frame = normal_layer({plate, reversed(rectangle(0.25, 0.25, 9.75, 9.75))});
    EXPECT_EQ(narrow_bodies(frame).rings, 2U) << "the moved rings cross each other";
}

TEST(NarrowArea, IsWhereAGrownInsetDoesNotReach) {
    // A bar between two squares.
    const double thick = 0.08;
    const Layer layer = normal_layer({{{0, 0},
                                       {2, 0},
                                       {2, 1},
                                       {4, 1},
                                       {4, 0},
                                       {6, 0},
                                       {6, 2},
                                       {4, 2},
                                       {4, 1 + thick},
                                       {2, 1 + thick},
                                       {2, 2},
                                       {0, 2}}});
    const Layer narrow = narrow_area(layer, offset(layer, -0.05), 0.05);
    ASSERT_EQ(narrow.rings, 1U);
    EXPECT_NEAR(measure(narrow).area_mm2, 2 * thick, 0.01);
    for (const Point2& p : narrow.points) {
        EXPECT_GE(p.x, 1.9);
        EXPECT_LE(p.x, 4.1);
    }
}

} // namespace
} // namespace lamella::narrow_bodies_cases
