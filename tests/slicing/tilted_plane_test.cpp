#include "lamella/core/error.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "slicing/tilted_plane.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace lamella::tilted_plane_cases {
namespace {

int sign(double x) {
    return (x > 0) - (x < 0);
}

TEST(TiltedPlane, DecidesTheSideAsIntegersDo) {
    test::Random random(52);
    int on = 0;
    for (int round = 0; round < 20'000; ++round) {
        // Small numbers often lie in the plane; the products of large ones need more than 53 bits.
        const std::int64_t most = round % 2 == 0 ? 3 : std::int64_t{1} << 40;
        const auto number = [&] {
            return random.integer(-most, most);
        };
        __extension__ using Wide = __int128;
        const std::int64_t n[3] = {number(), number(), number()};
        const std::int64_t o[3] = {number(), number(), number()};
        std::int64_t p[3] = {number(), number(), number()};
        if (n[0] == 0 && n[1] == 0 && n[2] == 0)
            continue;
        if (round % 3 == 0) { // in the plane, or one unit beside it
            const std::int64_t times = random.integer(-1, 1);
            p[0] = o[0] + (most > 3 ? n[1] / 4 : n[1]) * times + random.integer(0, 1);
            p[1] = o[1] - (most > 3 ? n[0] / 4 : n[0]) * times;
            p[2] = o[2];
        }
        Wide exact = 0;
        for (int k = 0; k < 3; ++k)
            exact += Wide{p[k] - o[k]} * n[k];
        const auto point = [](const std::int64_t* x) {
            return Point3{static_cast<double>(x[0]), static_cast<double>(x[1]), static_cast<double>(x[2])};
        };
        const double z = TiltedPlane(point(o), point(n))(point(p)).z;
        ASSERT_EQ(sign(z), (exact > 0) - (exact < 0)) << "round " << round;
        const double length = std::sqrt(static_cast<double>(n[0]) * static_cast<double>(n[0]) +
                                        static_cast<double>(n[1]) * static_cast<double>(n[1]) +
                                        static_cast<double>(n[2]) * static_cast<double>(n[2]));
        ASSERT_NEAR(z, static_cast<double>(exact) / length, 4e-15 * std::abs(z));
        on += exact == 0 ? 1 : 0;
    }
    EXPECT_GT(on, 1000);
}

TEST(TiltedPlane, DecidesTheSideOfTinyAndHugeNumbers) {
    for (const double scale : {0x1p-1000, 0x1p-500, 1.0, 0x1p500, 0x1p1000})
        for (const double length : {0x1p-1000, 1.0, 0x1p1000}) {
            const TiltedPlane plane({3 * scale, 0, 0}, {4 * length, 0, 3 * length});
            EXPECT_EQ(sign(plane({0, 5 * scale, 4 * scale}).z), 0);
            EXPECT_EQ(sign(plane({0, 5 * scale, std::nextafter(4 * scale, 1e308)}).z), 1);
            EXPECT_EQ(sign(plane({0, 5 * scale, std::nextafter(4 * scale, 0)}).z), -1);
        }
}

TEST(TiltedPlane, MapsItsFrameToThePoints) {
    test::Random random(53);
    for (int round = 0; round < 200; ++round) {
        const auto point = [&] {
            return Point3{random.real(-9, 9), random.real(-9, 9), random.real(-9, 9)};
        };
        const TiltedPlane plane(point(), point());
        const Point3 p = point();
        const Point3 back = plane.from_frame()(plane(p));
        EXPECT_NEAR(back.x, p.x, 1e-13);
        EXPECT_NEAR(back.y, p.y, 1e-13);
        EXPECT_NEAR(back.z, p.z, 1e-13);
    }
}

TEST(TiltedPlane, NamesWhatIsNoPlane) {
    for (const double x : {0.0, std::numeric_limits<double>::infinity()})
        test::expect_error(ErrorKind::usage, {"normal of a section", "expected three finite numbers"}, [&] {
            static_cast<void>(TiltedPlane({0, 0, 0}, {x, 0, 0}));
        });
}

} // namespace
} // namespace lamella::tilted_plane_cases
