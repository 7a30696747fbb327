#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"

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
#include <utility>
#include <vector>

namespace lamella::unreached_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::rounds_within_reason;
using test::turned;

/// The area that strokes of this reach leave bare.
double bare_area(const Layer& layer, const std::vector<Stroke>& strokes, double reach = 0.1) {
    const Reached reached{.strokes = strokes, .corners = {}};
    return unreached_area(layer, reached, MeasuringLines(layer, reached, reach));
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

// Vectors that follow one another are measured together, others one by one.
TEST(UnreachedArea, DoesNotDependOnTheOrderOfVectors) {
    Random random(52);
    const Layer layer = normal_layer({rectangle(0, 0, 10, 10)});
    for (int round = 0; round < rounds_within_reason(60); ++round) {
        // Hatch lines to and fro, of strokes that also turn back, jump and differ in their reach, some of it
        // 0.
        std::vector<Stroke> strokes;
        double x = random.real(-1, 8);
        double step = 0.1;
        for (int i = 0; i < 120; ++i) {
            if (random.integer(0, 9) == 0)
                step = random.real(-0.3, 0.3);
            if (random.integer(0, 29) == 0)
                x = random.real(-1, 10);
            x += step;
            const Point2 low{x + random.real(0, 0.2), random.real(-1, 4)};
            const Point2 high{x + random.real(0, 2), random.real(5, 11)};
            const double reach = random.integer(0, 3) > 0 ? 0.1 : std::max(0.0, random.real(-0.2, 0.2));
            strokes.push_back(i % 2 == 0 ? Stroke{low, high, reach} : Stroke{high, low, reach});
        }
        const Reached reached{.strokes = strokes, .corners = {}};
        const MeasuringLines lines(layer, reached, 0.1);
        const double area = unreached_area(layer, reached, lines);
        for (int again = 0; again < 3; ++again) {
            for (std::size_t i = strokes.size() - 1; i > 0; --i)
                std::swap(strokes[i],
                          strokes[static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(i)))]);
            EXPECT_NEAR(unreached_area(layer, {.strokes = strokes, .corners = {}}, lines), area, 1e-9)
                << round;
        }
    }
}

TEST(BareBodies, AreTheBodiesThatStrokesLeaveBare) {
    // A row of squares, of which each second one is reached.
    std::vector<Contour> squares;
    Reached reached;
    for (int i = 0; i < 10; ++i) {
        squares.push_back(rectangle(3 * i, 0, 3 * i + 1, 1));
        if (i % 2 == 0)
            reached.strokes.push_back({{3.0 * i - 1, 0.5}, {3.0 * i + 2, 0.5}, 0.75});
    }
    const Layer layer = normal_layer(squares);
    const Layer bare = bare_bodies(layer, reached, MeasuringLines(layer, reached, 0.75), 0.75);
    ASSERT_EQ(bare.rings, 5U);
    EXPECT_TRUE(in_normal_form(bare));
    for (std::size_t i = 0; i < bare.rings; ++i)
        EXPECT_EQ(bare.contour(i).front().x, 3.0 * (2 * static_cast<double>(i) + 1));
}

} // namespace
} // namespace lamella::unreached_cases
