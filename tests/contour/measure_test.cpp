#include "lamella/contour/measure.hpp"

#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace lamella {
namespace {

std::vector<Point2> circle(double radius, std::size_t segments, Point2 centre = {}) {
    std::vector<Point2> ring;
    for (std::size_t i = 0; i < segments; ++i) {
        const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(segments);
        ring.push_back({centre.x + radius * std::cos(angle), centre.y + radius * std::sin(angle)});
    }
    return ring;
}

double circle_area(double radius, std::size_t segments) {
    const auto n = static_cast<double>(segments);
    return 0.5 * n * radius * radius * std::sin(2 * std::numbers::pi / n);
}

TEST(RingArea, IsPositiveForCounterClockwiseAndNegativeForClockwise) {
    const std::vector<Point2> square{{1, 1}, {4, 1}, {4, 3}, {1, 3}};
    EXPECT_EQ(ring_area(square), 6.0);
    EXPECT_EQ(ring_area(std::vector<Point2>(square.rbegin(), square.rend())), -6.0);
}

TEST(RingArea, OfFewerThanThreePointsIsZero) {
    EXPECT_EQ(ring_area({}), 0.0);
    EXPECT_EQ(ring_area(std::vector<Point2>{{1, 2}}), 0.0);
    EXPECT_EQ(ring_area(std::vector<Point2>{{1, 2}, {5, 9}}), 0.0);
}

TEST(RingArea, CountsEveryPointOfRingsOfAnySize) {
    for (std::size_t n = 3; n < 40; ++n)
        EXPECT_NEAR(ring_area(circle(2, n)), circle_area(2, n), 1e-13) << n;
}

TEST(RingArea, LosesNoDigitsFarFromTheOrigin) {
    // A square of 1/1024 mm at ten kilometres: a sum of x_i * y_j would be of the order of 1e14, and a
    // single rounding of it larger than the area.
    const double x = 1e7;
    const double s = 1.0 / 1024;
    const std::vector<Point2> square{{x, x}, {x + s, x}, {x + s, x + s}, {x, x + s}};
    EXPECT_EQ(ring_area(square), s * s);
    EXPECT_EQ(ring_area(std::vector<Point2>(square.rbegin(), square.rend())), -s * s);
    // A circle in such a place is as good as its rounded points.
    const double expected = circle_area(5, 360);
    EXPECT_NEAR(ring_area(circle(5, 360, {1e6, -1e6})), expected, 2 * std::numbers::pi * 5 * 1e6 * 3e-16);
}

TEST(ContourLength, IncludesTheWayBackOfRingsOnly) {
    const std::vector<Point2> triangle{{0, 0}, {3, 0}, {3, 4}};
    EXPECT_EQ(contour_length(triangle, true), 12.0);
    EXPECT_EQ(contour_length(triangle, false), 7.0);
    EXPECT_EQ(contour_length({}, true), 0.0);
    EXPECT_EQ(contour_length(std::vector<Point2>{{1, 1}}, true), 0.0);
}

TEST(ContourLength, CountsEverySegmentOfContoursOfAnySize) {
    for (std::size_t n = 3; n < 40; ++n) {
        const double side = 2 * 2 * std::sin(std::numbers::pi / static_cast<double>(n));
        EXPECT_NEAR(contour_length(circle(2, n), true), side * static_cast<double>(n), 1e-12) << n;
        EXPECT_NEAR(contour_length(circle(2, n), false), side * static_cast<double>(n - 1), 1e-12) << n;
    }
}

TEST(Measure, SubtractsHolesAndCountsChains) {
    const LayerMeasure m = measure(test::layer_of(
        {test::rectangle(0, 0, 10, 10), test::reversed(test::rectangle(2, 2, 4, 4))}, {{{20, 0}, {20, 5}}}));
    EXPECT_EQ(m.contours, 3U);
    EXPECT_EQ(m.holes, 1U);
    EXPECT_EQ(m.open_chains, 1U);
    EXPECT_EQ(m.points, 10U);
    EXPECT_EQ(m.area_mm2, 96.0);
    EXPECT_EQ(m.perimeter_mm, 40.0 + 8.0 + 5.0);
}

} // namespace
} // namespace lamella
