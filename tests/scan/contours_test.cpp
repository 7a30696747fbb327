#include "fixtures/layers.hpp"
#include "scan/contours.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

namespace lamella::scan_contour_cases {
namespace {

using test::Contour;
using test::contours;
using test::diamond;
using test::normal_layer;
using test::rectangle;
using test::reversed;

TEST(FollowedContours, BeginFarthestInTheDirection) {
    const Layer layer = normal_layer({diamond(0, 0, 5), diamond(20, 0, 5)});
    ContourRule rule;
    rule.start_direction_degrees = 90;
    for (const Contour& ring : contours(followed(layer, rule, 1, 1)))
        EXPECT_EQ(ring.front().y, 5);
    rule.start_direction_degrees = 180;
    for (const Contour& ring : contours(followed(layer, rule, 1, 1)))
        EXPECT_EQ(ring.front().y, 0);
}

TEST(FollowedContours, BeginAtTheSharpestCorner) {
    ContourRule rule;
    rule.start = StartPoint::sharpest;
    const Layer needle = normal_layer({{{0, 0}, {2, -1}, {10, 0.5}, {2, 1}}});
    EXPECT_EQ(contours(followed(needle, rule, 1, 1))[0].front(), (Point2{10, 0.5}));
}

TEST(FollowedContours, BeginAtNoConcaveCornerWhereThereIsAConvexOne) {
    ContourRule rule;
    rule.start = StartPoint::sharpest;
    const Contour notched{{0, 0}, {10, 0}, {10, 10}, {5.7, 10}, {5, 9}, {4.3, 10}, {0, 10}};
    EXPECT_EQ(contours(followed(normal_layer({notched}), rule, 1, 1))[0].front(), (Point2{0, 0}));
    // As a hole it has one: the material is on the other side.
    for (const Contour& ring :
         contours(followed(normal_layer({rectangle(-5, -5, 15, 15), reversed(notched)}), rule, 1, 1)))
        EXPECT_EQ(ring.front(), ring.size() == 4 ? (Point2{-5, -5}) : (Point2{5, 9}));
}

TEST(FollowedContours, BeginAtRandomCornersByTheSeed) {
    ContourRule rule;
    rule.start = StartPoint::random;
    Layer layer = normal_layer({rectangle(0, 0, 4, 4)});
    std::set<std::pair<double, double>> starts;
    for (std::uint64_t i = 0; i < 50; ++i) {
        layer.index = i;
        const Point2 start = contours(followed(layer, rule, 1, 1))[0].front();
        EXPECT_EQ(start, contours(followed(layer, rule, 1, 1))[0].front());
        starts.insert({start.x, start.y});
    }
    EXPECT_EQ(starts.size(), 4U);
}

TEST(FollowedContours, AreTheSameRings) {
    std::vector<Contour> rings;
    for (int x = 0; x < 10; ++x)
        for (int y = 0; y < 10; ++y)
            rings.push_back(x % 2 == 0 ? diamond(3 * x, 3 * y, 1)
                                       : rectangle(3 * x, 3 * y, 3 * x + 1, 3 * y + 1));
    const Layer layer = normal_layer(rings);
    for (const StartPoint start : {StartPoint::aligned, StartPoint::sharpest, StartPoint::random}) {
        ContourRule rule;
        rule.start = start;
        EXPECT_TRUE(same_contours(normal_form(followed(layer, rule, 1, 1)), layer));
    }
}

TEST(FollowedContours, GoBackAndForthOverTheLayer) {
    std::vector<Contour> rings;
    for (int x = 0; x < 30; ++x)
        for (int y = 0; y < 30; ++y)
            rings.push_back(rectangle(3 * x, 3 * y, 3 * x + 1, 3 * y + 1));
    const std::vector<Contour> order = contours(followed(normal_layer(rings), ContourRule{}, 1, 1));
    double jumps = 0;
    for (std::size_t i = 1; i < order.size(); ++i)
        jumps += std::hypot(order[i].front().x - order[i - 1].front().x,
                            order[i].front().y - order[i - 1].front().y);
    EXPECT_LT(jumps, 1.05 * 3 * 900); // hardly longer than from neighbour to neighbour
}

TEST(FollowedContours, OfNothingAreNone) {
    EXPECT_EQ(followed(Layer{}, ContourRule{}, 1, 1).contours(), 0U);
}

} // namespace
} // namespace lamella::scan_contour_cases
