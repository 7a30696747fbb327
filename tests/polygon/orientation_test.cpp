#include "fixtures/random.hpp"
#include "polygon/orientation.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>

namespace lamella {
namespace {

using test::Random;

__extension__ using Wide = __int128;

/// The same question for integers that are small enough to be answered in 128 bits.
int integer_orientation(const std::array<std::int64_t, 6>& p) {
    const Wide d = Wide{p[0] - p[4]} * (p[3] - p[5]) - Wide{p[1] - p[5]} * (p[2] - p[4]);
    return (d > 0) - (d < 0);
}

TEST(Orientation, OfSimpleTriplesIsAsDrawn) {
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {0, 1}), 1);
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {0, -1}), -1);
    EXPECT_EQ(orientation({0, 0}, {1, 0}, {5, 0}), 0);
    EXPECT_EQ(orientation({3, 4}, {3, 4}, {7, 8}), 0);
}

TEST(Orientation, OfNearlyCollinearPointsIsExact) {
    Random random(1);
    int collinear = 0;
    for (int i = 0; i < 20000; ++i) {
        // Points of a line with integer coordinates up to 2^40, some moved aside by one.
        const std::int64_t dx = random.integer(1, 1 << 20);
        const std::int64_t dy = random.integer(-(1 << 20), 1 << 20);
        const std::int64_t s = random.integer(0, 1 << 19);
        const std::int64_t t = random.integer(0, 1 << 19);
        const std::array<std::int64_t, 6> p{dx * s + random.integer(-1, 1), dy * s, dx * t,
                                            dy * t + random.integer(-1, 1), 0,      0};
        const int expected = integer_orientation(p);
        collinear += expected == 0 ? 1 : 0;
        std::array<Point2, 3> q;
        for (std::size_t k = 0; k < 3; ++k)
            q[k] = {static_cast<double>(p[2 * k]) * 0x1p-30, static_cast<double>(p[2 * k + 1]) * 0x1p-30};
        ASSERT_EQ(orientation(q[0], q[1], q[2]), expected);
        ASSERT_EQ(orientation(q[1], q[2], q[0]), expected);
        ASSERT_EQ(orientation(q[1], q[0], q[2]), -expected);
        ASSERT_EQ(exact_orientation(q[0], q[1], q[2]), expected);
    }
    EXPECT_GT(collinear, 1000); // the hard case did occur
}

TEST(Orientation, OfAPointOneUnitInTheLastPlaceOffALineIsSeen) {
    const double x = 0.1;
    const double up = std::nextafter(x, 1.0);
    const double down = std::nextafter(x, 0.0);
    EXPECT_EQ(orientation({12, 12}, {24, 24}, {x, x}), 0);
    EXPECT_EQ(orientation({12, 12}, {24, 24}, {x, up}), 1);
    EXPECT_EQ(orientation({12, 12}, {24, 24}, {x, down}), -1);
}

TEST(Orientation, IsExactAtTheEndsOfTheNumberRange) {
    constexpr double huge = std::numeric_limits<double>::max();
    constexpr double tiny = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {huge, -huge}), -1);
    EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {tiny, tiny}), 0);
    EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {0, tiny}), 1);
    EXPECT_EQ(orientation({-huge, -huge}, {huge, huge}, {tiny, 0}), -1);
    EXPECT_EQ(orientation({0, 0}, {tiny, tiny}, {3 * tiny, 3 * tiny}), 0);
    EXPECT_EQ(orientation({0, 0}, {tiny, tiny}, {3 * tiny, 4 * tiny}), 1);
    EXPECT_EQ(orientation({0, 0}, {huge, tiny}, {huge / 2, tiny}), 1);
    EXPECT_EQ(orientation({0, 0}, {huge, 2 * tiny}, {huge / 2, tiny}), 0);
}

TEST(Orientation, DoesNotChangeUnderPowersOfTwo) {
    Random random(2);
    for (int i = 0; i < 2000; ++i) {
        const Point2 a{random.real(-1, 1), random.real(-1, 1)};
        const Point2 b{random.real(-1, 1), random.real(-1, 1)};
        const double t = random.real(0, 1);
        const Point2 c{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
        const int expected = orientation(a, b, c);
        for (const double scale : {0x1p900, 0x1p-900, 0x1p-20}) {
            const auto scaled = [scale](const Point2& p) {
                return Point2{p.x * scale, p.y * scale};
            };
            ASSERT_EQ(orientation(scaled(a), scaled(b), scaled(c)), expected);
        }
    }
}

} // namespace
} // namespace lamella
