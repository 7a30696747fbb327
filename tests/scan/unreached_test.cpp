#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/plain_rings.hpp"
#include "polygon/segment_distance.hpp"
#include "scan/turned_layer.hpp"
#include "scan/unreached.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

namespace lamella::unreached_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::regular_polygon;
using test::reversed;
using test::rounds_within_reason;
using test::turned;

TEST(NarrowPlaces, AreNoneWhereAllIsWide) {
    for (const Contour& ring : {rectangle(0, 0, 10, 10), regular_polygon(300, 5), regular_polygon(5, 2)})
        EXPECT_EQ(narrow_points(normal_layer({ring}), offset(normal_layer({ring}), -0.05), 0.05).rings, 0U);
    const Layer plate = normal_layer({rectangle(0, 0, 10, 10), reversed(regular_polygon(40, 1))});
    EXPECT_EQ(narrow_points(plate, offset(plate, -0.05), 0.05).rings, 0U);
}

TEST(UnreachedArea, IsExactWhereNothingAndWhereAllIsReached) {
    Random random(3);
    for (int round = 0; round < rounds_within_reason(200); ++round) {
        const double length = random.real(0.1, 20);
        const double thick = random.real(0.01, 0.3);
        const Layer wall = turned(layer_of({rectangle(0, 0, length, thick)}), random.real(0, 360), {});
        EXPECT_NEAR(unreached_area(wall, {}), length * thick, 1e-9);
        const std::vector<Stroke> far{{{50, 50}, {60, 60}, 0.1}};
        EXPECT_NEAR(unreached_area(wall, far), length * thick, 1e-9);
        const std::vector<Stroke> all{{{-30, 0}, {30, 0}, 40}};
        EXPECT_EQ(unreached_area(wall, all), 0);
    }
    // Half of it is reached, to a few steps.
    const Layer wall = layer_of({rectangle(0, 0, 10, 0.2)});
    const std::vector<Stroke> half{{{-1, 0}, {11, 0}, 0.1}};
    EXPECT_NEAR(unreached_area(wall, half), 1, 0.02);
}

std::vector<Stroke> random_strokes(Random& random, std::int64_t most, double reach) {
    std::vector<Stroke> strokes;
    for (std::int64_t n = random.integer(0, most); n > 0; --n) {
        const Point2 from{random.real(-6, 6), random.real(-6, 6)};
        strokes.push_back({from, {random.real(-6, 6), random.real(-6, 6)}, reach});
    }
    return strokes;
}

bool is_reached(const std::vector<Stroke>& strokes, const Point2& p) {
    return std::any_of(strokes.begin(), strokes.end(), [&](const Stroke& stroke) {
        return test::distance_from_segment(p, stroke.from, stroke.to) <= stroke.reach;
    });
}

TEST(UnreachedArea, IsThatOfPointsOnAFineGrid) {
    Random random(711);
    for (int round = 0; round < rounds_within_reason(40); ++round) {
        const Layer layer = normal_layer({test::star(random, {0, 0}, 5)});
        const std::vector<Stroke> strokes = random_strokes(random, 12, 0.4);
        constexpr double step = 0.05;
        double expected = 0;
        for (double x = -5; x < 5; x += step)
            for (double y = -5; y < 5; y += step) {
                const Point2 p{x + step / 2, y + step / 2};
                expected += test::plain_winding(layer, p) > 0 && !is_reached(strokes, p) ? step * step : 0;
            }
        EXPECT_NEAR(unreached_area(layer, strokes), expected, 0.02 * measure(layer).area_mm2) << round;
    }
}

TEST(UnreachedArea, NeverGrowsWithMoreStrokes) {
    Random random(712);
    for (int round = 0; round < rounds_within_reason(60); ++round) {
        const Layer layer = normal_layer({test::star(random, {0, 0}, 5)});
        std::vector<Stroke> strokes;
        double before = unreached_area(layer, strokes);
        EXPECT_NEAR(before, measure(layer).area_mm2, 1e-9);
        for (int i = 0; i < 10; ++i) {
            const std::vector<Stroke> more = random_strokes(random, 2, 0.5);
            strokes.insert(strokes.end(), more.begin(), more.end());
            const double after = unreached_area(layer, strokes);
            EXPECT_LE(after, before + 1e-9) << round;
            EXPECT_GE(after, 0) << round;
            before = after;
        }
    }
}

TEST(BarePoints, AreTheBodiesThatStrokesLeaveBare) {
    // A row of squares, of which each second one is reached.
    std::vector<Contour> squares;
    std::vector<Stroke> strokes;
    for (int i = 0; i < 10; ++i) {
        squares.push_back(rectangle(3 * i, 0, 3 * i + 1, 1));
        if (i % 2 == 0)
            strokes.push_back({{3.0 * i - 1, 0.5}, {3.0 * i + 2, 0.5}, 0.75});
    }
    const Layer bare = bare_points(normal_layer(squares), strokes);
    ASSERT_EQ(bare.rings, 5U);
    EXPECT_TRUE(in_normal_form(bare));
    for (std::size_t i = 0; i < bare.rings; ++i)
        EXPECT_EQ(bare.contour(i).front().x, 3.0 * (2 * static_cast<double>(i) + 1));
}

TEST(NarrowPoints, AreWhereAGrownInsetDoesNotReach) {
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
    const Layer narrow = narrow_points(layer, offset(layer, -0.05), 0.05);
    ASSERT_EQ(narrow.rings, 1U);
    EXPECT_NEAR(measure(narrow).area_mm2, 2 * thick, 0.01);
    for (const Point2& p : narrow.points) {
        EXPECT_GE(p.x, 1.9);
        EXPECT_LE(p.x, 4.1);
    }
}

TEST(Strokes, AreTheVectorsOfALayer) {
    const Layer lines = layer_of({rectangle(0, 0, 4, 4)}, {{{1, 1}, {2, 2}, {3, 1}}});
    const std::vector<Point2> hatches{{5, 5}, {6, 6}, {7, 7}, {8, 8}};
    std::vector<Stroke> strokes;
    add_strokes(lines, hatches, 0.25, strokes);
    ASSERT_EQ(strokes.size(), 4U + 2 + 2);
    for (const Stroke& stroke : strokes)
        EXPECT_EQ(stroke.reach, 0.25);
    EXPECT_TRUE(std::any_of(strokes.begin(), strokes.end(), [](const Stroke& stroke) {
        return stroke.from == Point2{0, 4} && stroke.to == Point2{0, 0};
    })) << "rings are closed";
    EXPECT_FALSE(std::any_of(strokes.begin(), strokes.end(), [](const Stroke& stroke) {
        return stroke.from == Point2{3, 1};
    })) << "chains are not";
}

} // namespace
} // namespace lamella::unreached_cases
