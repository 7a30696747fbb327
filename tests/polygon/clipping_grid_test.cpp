#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "polygon/clipping_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lamella {
namespace {

using test::Random;

TEST(ClippingGrid, RoundsToTheNearestOfItsPositions) {
    Random random(231);
    for (int round = 0; round < 1000; ++round) {
        const double size = std::ldexp(1, static_cast<int>(random.integer(-30, 30)));
        const double away = random.integer(0, 1) == 0 ? 0 : random.real(-1e6, 1e6);
        std::vector<Point2> points;
        for (int i = 0; i < 20; ++i)
            points.push_back({away + size * random.real(-1, 1), away + size * random.real(-1, 1)});
        const ClippingGrid grid(points);
        int exponent = 0;
        EXPECT_EQ(std::frexp(grid.unit(), &exponent), 0.5) << "a power of two";
        double largest = 0;
        double x0 = points[0].x;
        double x1 = x0;
        double y0 = points[0].y;
        double y1 = y0;
        for (const Point2& p : points) {
            largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
            x0 = std::min(x0, p.x);
            x1 = std::max(x1, p.x);
            y0 = std::min(y0, p.y);
            y1 = std::max(y1, p.y);
        }
        EXPECT_LE(grid.unit(), std::max(0x1p-36 * std::max(x1 - x0, y1 - y0), 0x1p-52 * largest));
        for (const Point2& p : points) {
            const Point2 position = grid.position(p);
            EXPECT_EQ(position.x, std::nearbyint(position.x));
            EXPECT_EQ(position.y, std::nearbyint(position.y));
            EXPECT_LE(std::max(std::abs(position.x), std::abs(position.y)), 0x1p37);
            const Point2 back = grid.point(position);
            EXPECT_LE(std::abs(back.x - p.x), grid.unit() / 2);
            EXPECT_LE(std::abs(back.y - p.y), grid.unit() / 2);
            EXPECT_EQ(grid.position(back), position);
        }
    }
}

TEST(ClippingGrid, HasRoomForItsMargin) {
    const std::vector<Point2> points{{0, 0}, {1, 1}};
    const ClippingGrid grid(points, 1e6);
    EXPECT_GE(grid.unit(), 1e6 * 0x1p-37);
    EXPECT_LE(std::abs(grid.position({1e6, -1e6}).x), 0x1p37);
}

TEST(ClippingGrid, OfOnePointAndOfNoneRoundsNothingAway) {
    const std::vector<Point2> one{{3.25, -7}};
    EXPECT_EQ(ClippingGrid(one).unit(), 1);
    EXPECT_EQ(ClippingGrid({}).unit(), 1);
}

TEST(ClippingGrid, RefusesCoordinatesWhoseProductsOverflow) {
    const std::vector<Point2> far{{0, 0}, {1e200, 0}};
    test::expect_error(ErrorKind::limit, {"1e150"}, [&] { static_cast<void>(ClippingGrid(far)); });
}

} // namespace
} // namespace lamella
