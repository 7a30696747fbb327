#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/boolean.hpp"
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
#include <numbers>
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

/// The area that strokes of this reach leave bare.
double bare_area(const Layer& layer, const std::vector<Stroke>& strokes, double reach = 0.1) {
    const Reached reached{.strokes = strokes, .corners = {}};
    return unreached_area(layer, reached, MeasuringLines(layer, reached, reach));
}

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

TEST(UnreachedArea, IsExactWhereNothingAndWhereAllIsReached) {
    Random random(3);
    for (int round = 0; round < rounds_within_reason(200); ++round) {
        const double length = random.real(0.1, 20);
        const double thick = random.real(0.01, 0.3);
        const Layer wall = turned(layer_of({rectangle(0, 0, length, thick)}), random.real(0, 360), {});
        EXPECT_NEAR(bare_area(wall, {}), length * thick, 1e-9);
        const std::vector<Stroke> far{{{50, 50}, {60, 60}, 0.1}};
        EXPECT_NEAR(bare_area(wall, far), length * thick, 1e-9);
        const std::vector<Stroke> all{{{-30, 0}, {30, 0}, 40}};
        EXPECT_EQ(bare_area(wall, all, 40), 0);
    }
    // Half of it is reached, to a few steps.
    const Layer wall = layer_of({rectangle(0, 0, 10, 0.2)});
    const std::vector<Stroke> half{{{-1, 0}, {11, 0}, 0.1}};
    EXPECT_NEAR(bare_area(wall, half), 1, 0.01);
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
        EXPECT_NEAR(bare_area(layer, strokes, 0.4), expected, 0.02 * measure(layer).area_mm2) << round;
    }
}

TEST(UnreachedArea, NeverGrowsWithMoreStrokes) {
    Random random(712);
    for (int round = 0; round < rounds_within_reason(60); ++round) {
        const Layer layer = normal_layer({test::star(random, {0, 0}, 5)});
        std::vector<Stroke> strokes;
        double before = bare_area(layer, strokes, 0.4);
        EXPECT_NEAR(before, measure(layer).area_mm2, 1e-9);
        for (int i = 0; i < 10; ++i) {
            const std::vector<Stroke> more = random_strokes(random, 2, 0.5);
            strokes.insert(strokes.end(), more.begin(), more.end());
            const double after = bare_area(layer, strokes, 0.4);
            EXPECT_LE(after, before + 1e-9) << round;
            EXPECT_GE(after, 0) << round;
            before = after;
        }
    }
}

TEST(UnreachedArea, OfWideMaterialCountsInLargeSpotsOnly) {
    // Two gaps between strokes; the narrower one is a spot below the limit.
    const Layer layer = layer_of({rectangle(0, 0, 4, 1)});
    const std::vector<Stroke> strokes{{{-1, 0.5}, {0.5, 0.5}, 0.6}, {{2, 0.5}, {2.05, 0.5}, 0.6}};
    const Reached reached{.strokes = strokes, .corners = {}};
    const MeasuringLines lines(layer, reached, 0.1);
    const double all = unreached_area(layer, reached, lines);
    const auto within = [](const Layer& wide, double tip_mm2) {
        return WideMaterial{.points = [wide] { return wide; }, .tip_mm2 = tip_mm2};
    };
    const double right = unreached_area(layer_of({rectangle(2.05, 0, 4, 1)}), reached, lines);
    EXPECT_NEAR(unreached_area(layer, reached, lines, within(layer, 0)), all, 1e-9);
    EXPECT_NEAR(unreached_area(layer, reached, lines, within(layer, all / 2)), right, 0.01);
    EXPECT_EQ(unreached_area(layer, reached, lines, within(layer, 2)), 0);
    EXPECT_NEAR(unreached_area(layer, reached, lines, within(layer_of({rectangle(0, 0, 2, 1)}), 2)), right,
                0.01);
}

TEST(BarePoints, AreTheBodiesThatStrokesLeaveBare) {
    // A row of squares, of which each second one is reached.
    std::vector<Contour> squares;
    Reached reached;
    for (int i = 0; i < 10; ++i) {
        squares.push_back(rectangle(3 * i, 0, 3 * i + 1, 1));
        if (i % 2 == 0)
            reached.strokes.push_back({{3.0 * i - 1, 0.5}, {3.0 * i + 2, 0.5}, 0.75});
    }
    const Layer layer = normal_layer(squares);
    const Layer bare = bare_points(layer, reached, MeasuringLines(layer, reached, 0.75), 0.75);
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

TEST(Reached, IsWhatTheVectorsOfALayerReach) {
    const Layer lines = layer_of({rectangle(0, 0, 4, 4)}, {{{1, 1}, {2, 2}, {3, 1}}});
    const std::vector<Point2> hatches{{5, 5}, {6, 6}, {7, 7}, {8, 8}};
    Reached reached;
    reached.add(lines, hatches, 0.25);
    ASSERT_EQ(reached.strokes.size(), 4U + 2 + 2);
    for (const Stroke& stroke : reached.strokes)
        EXPECT_EQ(stroke.reach, 0.25);
    EXPECT_TRUE(std::any_of(reached.strokes.begin(), reached.strokes.end(), [](const Stroke& stroke) {
        return stroke.from == Point2{0, 4} && stroke.to == Point2{0, 0};
    })) << "rings are closed";
    EXPECT_FALSE(std::any_of(reached.strokes.begin(), reached.strokes.end(), [](const Stroke& stroke) {
        return stroke.from == Point2{3, 1};
    })) << "chains are not";
    EXPECT_EQ(reached.corners.size(), 4U);
}

// A ring reaches what `offset` adds to it, on both sides.
TEST(Reached, IncludesTheCornersOfRings) {
    Random random(713);
    for (int round = 0; round < rounds_within_reason(40); ++round) {
        const double angle = random.real(10, 170);
        const double degrees = random.real(0, 360);
        const Layer corner = turned(normal_layer({{{0, 0},
                                                   {5, 0},
                                                   {5 * std::cos(angle * std::numbers::pi / 180),
                                                    5 * std::sin(angle * std::numbers::pi / 180)}}}),
                                    degrees, {1, 2});
        const Layer grown = offset(corner, 0.2, {.corners = {.mitre_limit = reached_mitre}});
        Reached reached;
        reached.add(corner, {}, 0.2);
        const Layer band = combine(grown, corner, BooleanOperation::subtract);
        const MeasuringLines lines(grown, reached, 0.1);
        EXPECT_LT(unreached_area(band, reached, lines), 1e-9) << angle;
        const Layer beyond = combine(offset(corner, 1), grown, BooleanOperation::subtract);
        EXPECT_NEAR(unreached_area(beyond, reached, lines), measure(beyond).area_mm2, 1e-6) << angle;
    }
}

TEST(Reached, IsThatOfTheRoundedVectors) {
    Reached reached;
    reached.add(layer_of({{{0.004, 0}, {1, 0}, {1, 1.006}}}), std::vector<Point2>{{0.011, 0.019}, {2, 2}},
                0.1, {.step_mm = 0.01});
    EXPECT_TRUE(std::all_of(reached.strokes.begin(), reached.strokes.end(), [](const Stroke& stroke) {
        const auto whole = [](double mm) {
            return std::abs(mm * 100 - std::round(mm * 100)) < 1e-9;
        };
        return whole(stroke.from.x) && whole(stroke.from.y) && whole(stroke.to.x) && whole(stroke.to.y);
    }));
    EXPECT_EQ(reached.strokes.back().from, (Point2{0.01, 0.02}));
}

} // namespace
} // namespace lamella::unreached_cases
