#include "lamella/scan/scan.hpp"

#include "fixtures/layers.hpp"
#include "pipeline/length_around.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace lamella {
namespace {

/// Lines that fill a rectangle of 20 x 10 mm.
PointArray lines_of(HatchPattern pattern, double degrees) {
    ScanStrategy strategy;
    strategy.contours.count = 0;
    strategy.hatch.border = 0;
    strategy.hatch.pattern = pattern;
    strategy.hatch.angle_degrees = degrees;
    return scan(test::normal_layer({test::rectangle(0, 0, 20, 10)}), {}, {}, strategy)
        .vectors.hatches.front();
}

TEST(LengthAround, IsThatOfTheEdgesOrMore) {
    for (const HatchPattern pattern : {HatchPattern::lines, HatchPattern::meander, HatchPattern::stripes})
        for (const double degrees : {0.0, 30.0, 67.0, 90.0}) {
            SCOPED_TRACE(testing::Message() << hatch_pattern_name(pattern) << ", " << degrees);
            const double around = length_around(lines_of(pattern, degrees), 0.1);
            EXPECT_GT(around, 0.98 * 60);
            EXPECT_LT(around, 1.5 * 60); // in steps along edges that are not along lines
        }
}

TEST(LengthAround, CountsTheEdgesOfIslands) {
    for (const HatchPattern pattern : {HatchPattern::chessboard, HatchPattern::hexagons}) {
        const double around = length_around(lines_of(pattern, 0), 0.1);
        EXPECT_GT(around, 120) << hatch_pattern_name(pattern); // 60 are the edges of all of it
        EXPECT_LT(around, 60 + 2 * 2 * 200 / 5.0 * 1.5);
    }
}

TEST(LengthAround, OfNothingIsNothing) {
    EXPECT_EQ(length_around({}, 0.1), 0);
    EXPECT_EQ(length_around(PointArray(std::vector<Point2>{{1, 1}, {1, 1}}), 0.1), 0);
}

} // namespace
} // namespace lamella
