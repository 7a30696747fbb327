#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "slices/engine/grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace lamella {
namespace {

std::vector<GridPoint> snapped(double step, const std::vector<Point2>& contour, bool closed = true) {
    std::vector<GridPoint> scratch;
    const auto points = WriterGrid(step).snap(contour, closed, closed ? ring_area(contour) : 0, 0, scratch);
    return {points.begin(), points.end()};
}

TEST(WriterGrid, RoundsToTheNearestPointAndHalvesToEven) {
    const std::vector<Point2> chain{{0.4, -0.4}, {0.5, -0.5}, {1.5, -1.5}, {2.6, -2.6}, {1e9 + 0.4, -1e9}};
    const std::vector<GridPoint> expected{{0, 0}, {2, -2}, {3, -3}, {1'000'000'000, -1'000'000'000}};
    EXPECT_EQ(snapped(1, chain, false), expected);
}

TEST(WriterGrid, AgreesWithTheRoundingOfTheStandardLibrary) {
    std::mt19937_64 random(1);
    for (int i = 0; i < 20'000; ++i) {
        const double x =
            std::ldexp(static_cast<double>(random() >> 11U), static_cast<int>(random() % 62) - 64);
        const double y =
            -std::ldexp(static_cast<double>(random() >> 11U), static_cast<int>(random() % 62) - 64);
        const auto points = snapped(1, {{x, y}, {x + 5, y}}, false);
        ASSERT_EQ(points.front().x, static_cast<std::int64_t>(std::nearbyint(x))) << x;
        ASSERT_EQ(points.front().y, static_cast<std::int64_t>(std::nearbyint(y))) << y;
    }
}

TEST(WriterGrid, DropsPointsThatFallTogetherAlsoAcrossTheEnd) {
    const std::vector<Point2> ring{{0, 0}, {4, 0}, {4.1, 0.1}, {4, 4}, {0.2, 0.3}, {0.1, -0.1}};
    EXPECT_EQ(snapped(1, ring), (std::vector<GridPoint>{{0, 0}, {4, 0}, {4, 4}}));
    const std::vector<Point2> chain{{0, 0}, {0.1, 0}, {4, 0}, {0, 0}};
    EXPECT_EQ(snapped(1, chain, false), (std::vector<GridPoint>{{0, 0}, {4, 0}, {0, 0}}));
}

TEST(WriterGrid, CountsWhatACoarseStepLoses) {
    const auto warnings = [](double step) {
        RoundingLoss loss;
        const WriterGrid grid(step, &loss);
        std::vector<GridPoint> scratch;
        const std::vector<Point2> small{{0, 0}, {0.01, 0}, {0, 0.01}};
        const std::vector<Point2> large{{0, 0}, {5, 0}, {5.04, 0}, {5, 5}};
        static_cast<void>(grid.snap(large, true, 12, 3, scratch));
        static_cast<void>(grid.snap(small, true, 1, 4, scratch));
        return loss.findings().texts();
    };
    EXPECT_TRUE(warnings(0.001).empty());
    EXPECT_EQ(warnings(0.02),
              (std::vector<std::string>{"rounding left out 1 contour, first in layer 4; a part nearer to the "
                                        "origin, or smaller units where the format has units, lose less"}));
    EXPECT_EQ(warnings(0.1), (std::vector<std::string>{
                                 "rounding moved points by up to 0.04 mm, merged 1 of them with the one "
                                 "before, first in layer 3; a part nearer to the origin, or smaller units "
                                 "where the format has units, lose less",
                                 "rounding left out 1 contour, first in layer 4; a part nearer to the "
                                 "origin, or smaller units where the format has units, lose less"}));
}

TEST(WriterGrid, SaysNothingWhereACoarseStepLosesNothing) {
    RoundingLoss loss;
    const WriterGrid grid(1, &loss);
    std::vector<GridPoint> scratch;
    static_cast<void>(grid.snap(std::vector<Point2>{{0, 0}, {5, 0}, {5, 5}}, true, 12.5, 0, scratch));
    static_cast<void>(grid.snap(std::vector<Point2>{{0, 0}, {5.001, 0}, {5, 5}}, true, 12.5, 0, scratch));
    static_cast<void>(grid.snap_lines(std::vector<Point2>{{0, 0}, {5, 0}}, 0));
    EXPECT_TRUE(loss.findings().texts().empty());
}

TEST(WriterGrid, LeavesOutAndCountsLinesThatShrinkToAPoint) {
    RoundingLoss loss;
    const WriterGrid grid(0.001, &loss);
    EXPECT_EQ(grid.snap_lines(std::vector<Point2>{{0, 0}, {1e-4, 0}, {1, 0}, {1, 2}, {3, 3}, {3, 3.0001}}, 6),
              (std::vector<GridPoint>{{1000, 0}, {1000, 2000}}));
    ASSERT_EQ(loss.findings().texts().size(), 1U);
    EXPECT_TRUE(loss.findings().texts()[0].starts_with("rounding left out 2 hatch lines, first in layer 6;"))
        << loss.findings().texts()[0];
}

TEST(WriterGrid, ForgetsContoursThatShrinkToAPointOrALine) {
    EXPECT_TRUE(snapped(1, {{0, 0}, {0.3, 0}, {0, 0.3}}).empty());
    EXPECT_TRUE(snapped(1, {{0, 0}, {5, 0}, {5, 0.3}}).empty());
    EXPECT_TRUE(snapped(1, {{0, 0}, {0.3, 0}}, false).empty());
    EXPECT_TRUE(snapped(1, {}).empty());
}

TEST(WriterGrid, KeepsTheDirectionOfARingThatRoundingTurnsOver) {
    // A counter-clockwise sliver whose corners round to a clockwise triangle.
    const std::vector<Point2> sliver{{0, 0.4}, {10, 0.6}, {20, 0.6}};
    const std::vector<Point2> flipped{{0, 0}, {10, 1}, {20, 1}};
    ASSERT_GT(ring_area(sliver) * -1, 0); // it is clockwise as given
    std::vector<Point2> turned(sliver.rbegin(), sliver.rend());
    ASSERT_GT(ring_area(turned), 0);
    EXPECT_GT(grid_area(snapped(1, turned)), 0);
    EXPECT_LT(grid_area(snapped(1, sliver)), 0);

    const std::vector<Point2> bent{{0, 0.45}, {10, 0.55}, {20, 0.70}};
    ASSERT_GT(ring_area(bent), 0);
    ASSERT_LT(grid_area(std::vector<GridPoint>{{0, 0}, {10, 1}, {20, 1}}), 0); // what rounding alone makes
    EXPECT_GT(grid_area(snapped(1, bent)), 0);
}

TEST(WriterGrid, RefusesWhatItCannotHold) {
    EXPECT_THROW((void)snapped(0.001, {{0, 0}, {1e13, 0}, {0, 1}}), Error);
    EXPECT_THROW((void)snapped(0.001, {{0, 0}, {0, -1e13}, {0, 1}}), Error);
    EXPECT_THROW((void)snapped(1, {{0, 0}, {std::nan(""), 0}, {0, 1}}), Error);
    EXPECT_EQ(snapped(1, {{0, 0}, {0x1p51, 0}, {0, -0x1p51}})[1].x, std::int64_t{1} << 51);
}

TEST(RoundStep, IsTheNearestDoubleOfOneTwoOrFiveTimesAPowerOfTen) {
    for (const double step : {1e-6, 2e-6, 1e-4, 1e-3, 2e-3, 5e-3, 1e-2, 0.1, 0.5, 1.0, 20.0, 500.0})
        EXPECT_EQ(round_step(step), step);
    EXPECT_EQ(round_step(0.0015), 0.002);
    EXPECT_EQ(round_step(0.006), 0.01);
    EXPECT_EQ(round_step(70), 100);
}

TEST(GridArea, IsExactForWholeNumbers) {
    EXPECT_EQ(grid_area(std::vector<GridPoint>{{0, 0}, {10, 0}, {10, 10}, {0, 10}}), 100);
    EXPECT_EQ(grid_area(std::vector<GridPoint>{{0, 0}, {0, 10}, {10, 10}, {10, 0}}), -100);
    EXPECT_EQ(grid_area(std::vector<GridPoint>{{0, 0}, {0, 10}}), 0);
}

} // namespace
} // namespace lamella
