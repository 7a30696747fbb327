#include "lamella/contour/measure.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "scan/reached.hpp"
#include "scan/turned_layer.hpp"
#include "scan/unreached.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lamella::reached_cases {
namespace {

using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::rounds_within_reason;
using test::turned;

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
} // namespace lamella::reached_cases
