#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/offset.hpp"

#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

namespace lamella {
namespace {

using test::Contour;
using test::layer_of;
using test::rectangle;
using test::reversed;

double area(const Layer& layer) {
    return measure(layer).area_mm2;
}

Contour polygon(int n, double radius) {
    Contour ring;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        ring.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return ring;
}

TEST(Offset, OfNothingIsTheLayerItself) {
    const Layer layer = normal_form(layer_of({rectangle(0, 0, 4, 4)}));
    EXPECT_EQ(offset(layer, 0).points.data(), layer.points.data());
    EXPECT_EQ(offset(Layer{}, 1).contours(), 0U);
}

TEST(Offset, MovesTheSidesOfBodiesOutwardsAndOfHolesInwards) {
    const Layer frame = normal_form(layer_of({rectangle(0, 0, 10, 10), reversed(rectangle(3, 3, 7, 7))}));
    EXPECT_NEAR(area(offset(frame, 0.5)), 121 - 9, 1e-6);
    EXPECT_NEAR(area(offset(frame, -0.5)), 81 - 25, 1e-6);
    EXPECT_NEAR(area(offset(frame, 2)), 196, 1e-6); // the hole is gone
    EXPECT_EQ(offset(frame, -1.5).rings, 0U);
}

TEST(Offset, OfRegularPolygonsIsThatOfTheirCircles) {
    for (const int n : {4, 6, 12, 100, 1000})
        for (const double distance : {-3.0, -0.1, 0.1, 5.0}) {
            const Layer grown = offset(normal_form(layer_of({polygon(n, 10)})), distance);
            // The inscribed circle grows by the distance, and the corners stay corners.
            const double inner = 10 * std::cos(std::numbers::pi / n) + distance;
            EXPECT_NEAR(area(grown), n * inner * inner * std::tan(std::numbers::pi / n), 1e-5) << n;
            EXPECT_EQ(grown.points.size(), static_cast<std::size_t>(n));
        }
}

TEST(Offset, CutsSharpCornersOff) {
    const Layer needle = offset(normal_form(layer_of({{{0, 0}, {100, -1}, {100, 1}}})), 1);
    for (const Point2& p : needle.points)
        EXPECT_GE(p.x, -2.0);
}

TEST(Offset, UnitesWhatMeetsAndOverlaps) {
    const Layer apart = normal_form(layer_of({rectangle(0, 0, 4, 4), rectangle(5, 0, 9, 4)}));
    EXPECT_EQ(offset(apart, 0.25).rings, 2U);
    EXPECT_EQ(offset(apart, 0.75).rings, 1U);
    const Layer crossing = normal_form(layer_of({rectangle(0, 0, 4, 4), rectangle(2, 0, 6, 4)}));
    EXPECT_NEAR(area(offset(crossing, 1)), 8 * 6, 1e-6);
    EXPECT_NEAR(area(offset(crossing, -1)), 4 * 2, 1e-6);
    EXPECT_EQ(find_crossings(offset(crossing, 1)).count, 0U);
}

TEST(Offset, MakesNoWallsWhereAHoleRunsAlongItsBody) {
    const Layer notched = layer_of({rectangle(6, 5, 14, 6), reversed(rectangle(6, 5, 8, 6))});
    const Layer rest = layer_of({rectangle(8, 5, 14, 6)});
    for (const double distance : {0.05, 2.0, -0.2}) {
        const Layer moved = offset(notched, distance);
        EXPECT_EQ(moved.rings, 1U);
        EXPECT_NEAR(measure(moved).area_mm2, measure(offset(rest, distance)).area_mm2, 1e-8);
    }
}

TEST(Offset, KeepsOpenChains) {
    const Contour chain{{1, 1}, {20, 3}};
    const Layer grown = offset(normal_form(layer_of({rectangle(0, 0, 4, 4)}, {chain})), 1);
    ASSERT_EQ(grown.open_chains(), 1U);
    EXPECT_EQ(Contour(grown.contour(1).begin(), grown.contour(1).end()), chain);
    EXPECT_TRUE(in_normal_form(grown));
}

TEST(Offset, ByWhatIsNoDistanceIsRefused) {
    const Layer layer = normal_form(layer_of({rectangle(0, 0, 4, 4)}));
    EXPECT_THROW(static_cast<void>(offset(layer, std::numeric_limits<double>::infinity())), Error);
    EXPECT_THROW(static_cast<void>(offset(layer, std::nan(""))), Error);
}

} // namespace
} // namespace lamella
