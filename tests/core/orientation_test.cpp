#include "core/orientation.hpp"
#include "fixtures/random.hpp"

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

/// D of four points with integer coordinates below 2^38.
int integer_orientation(const std::array<std::array<std::int64_t, 3>, 4>& p) {
    const auto gap = [&](std::size_t k, std::size_t i) {
        return Wide{p[k][i] - p[0][i]};
    };
    const auto minor = [&](std::size_t i, std::size_t j) {
        return gap(1, i) * gap(2, j) - gap(1, j) * gap(2, i);
    };
    const Wide d = minor(1, 2) * gap(3, 0) + minor(2, 0) * gap(3, 1) + minor(0, 1) * gap(3, 2);
    return (d > 0) - (d < 0);
}

TEST(OrientationInSpace, OfSimplePointsIsAsDrawn) {
    EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}), 1);
    EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 5, -1}), -1);
    EXPECT_EQ(orientation({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {5, 7, 0}), 0);
    EXPECT_EQ(orientation({0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {5, 7, 0}), 0);
}

TEST(OrientationInSpace, OfNearlyCoplanarPointsIsExact) {
    Random random(3);
    int coplanar = 0;
    for (int i = 0; i < 20000; ++i) {
        // Whole numbers up to 2^38, four points of a plane or one unit off it; then the same divided, moved
        // by what single and double precision hold exactly, so that all ways to decide are gone through.
        const int bits = i % 3 == 0 ? 12 : 18;
        const auto part = [&] {
            return random.integer(-(std::int64_t{1} << bits), std::int64_t{1} << bits);
        };
        const std::array<std::int64_t, 3> u{part(), part(), part()};
        const std::array<std::int64_t, 3> v{part(), part(), part()};
        std::array<std::array<std::int64_t, 3>, 4> p{};
        for (auto& point : p) {
            const std::int64_t s = part();
            const std::int64_t t = part();
            for (std::size_t k = 0; k < 3; ++k)
                point[k] = s * u[k] + t * v[k];
        }
        p[static_cast<std::size_t>(random.integer(0, 3))][static_cast<std::size_t>(random.integer(0, 2))] +=
            random.integer(-1, 1);
        const int expected = integer_orientation(p);
        coplanar += expected == 0 ? 1 : 0;
        std::array<Point3, 4> q;
        for (std::size_t k = 0; k < 4; ++k)
            q[k] = {static_cast<double>(p[k][0]) * 0x1p-30, static_cast<double>(p[k][1]) * 0x1p-30,
                    static_cast<double>(p[k][2]) * 0x1p-30};
        ASSERT_EQ(orientation(q[0], q[1], q[2], q[3]), expected);
        ASSERT_EQ(orientation(q[1], q[2], q[0], q[3]), expected);
        ASSERT_EQ(orientation(q[1], q[0], q[2], q[3]), -expected);
        ASSERT_EQ(orientation(q[1], q[0], q[3], q[2]), expected);
        ASSERT_EQ(exact_orientation(q[0], q[1], q[2], q[3]), expected);
    }
    EXPECT_GT(coplanar, 1000);
}

TEST(OrientationInSpace, OfPointsOneUnitInTheLastPlaceOffAPlaneIsSeen) {
    const Point3 a{12, 12, 0.25};
    const Point3 b{24, 24, 17};
    const Point3 c{24, 24, -3};
    const double x = 0.1;
    EXPECT_EQ(orientation(a, b, c, {x, x, 5}), 0);
    EXPECT_EQ(orientation(a, b, c, {x, std::nextafter(x, 1.0), 5}),
              -orientation(a, b, c, {x, std::nextafter(x, 0.0), 5}));
    EXPECT_NE(orientation(a, b, c, {x, std::nextafter(x, 1.0), 5}), 0);
}

TEST(OrientationInSpace, DoesNotChangeUnderPowersOfTwoNorAtTheEndsOfTheNumberRange) {
    Random random(4);
    for (int i = 0; i < 2000; ++i) {
        std::array<Point3, 4> p;
        for (Point3& q : p)
            q = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        if (i % 2 == 0) // nearly on the plane
            p[3] = {(p[0].x + p[1].x + 2 * p[2].x) / 4, (p[0].y + p[1].y + 2 * p[2].y) / 4,
                    (p[0].z + p[1].z + 2 * p[2].z) / 4};
        const int expected = orientation(p[0], p[1], p[2], p[3]);
        ASSERT_EQ(exact_orientation(p[0], p[1], p[2], p[3]), expected);
        for (const double scale : {0x1p1000, 0x1p-900, 0x1p-20}) {
            std::array<Point3, 4> q = p;
            for (Point3& s : q)
                s = {s.x * scale, s.y * scale, s.z * scale};
            ASSERT_EQ(orientation(q[0], q[1], q[2], q[3]), expected);
        }
    }
    constexpr double huge = std::numeric_limits<double>::max();
    constexpr double tiny = std::numeric_limits<double>::denorm_min();
    EXPECT_EQ(orientation({-huge, -huge, 0}, {huge, -huge, 0}, {0, huge, 0}, {0, 0, tiny}), 1);
    EXPECT_EQ(orientation({-huge, -huge, 0}, {huge, -huge, 0}, {0, huge, 0}, {0, 0, -tiny}), -1);
    EXPECT_EQ(orientation({0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {huge, huge, tiny}), 1);
    EXPECT_EQ(orientation({0, 0, 0}, {tiny, 0, tiny}, {0, tiny, tiny}, {huge, huge, huge}), -1);
}

} // namespace
} // namespace lamella
