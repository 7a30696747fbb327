#include "lamella/core/unit_circle.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <numbers>

namespace lamella {
namespace {

TEST(UnitCircle, AgreesWithTheCLibraryWithinTwoUnitsInTheLastPlace) {
    for (std::uint64_t i = 0; i < 10007; ++i) {
        const CosSin v = cos_sin_turn(i, 10007);
        const double angle = 2 * std::numbers::pi * (static_cast<double>(i) / 10007);
        EXPECT_NEAR(v.cos, std::cos(angle), 1e-15) << i;
        EXPECT_NEAR(v.sin, std::sin(angle), 1e-15) << i;
        EXPECT_NEAR(v.cos * v.cos + v.sin * v.sin, 1, 5e-16) << i;
    }
}

TEST(UnitCircle, QuarterTurnsAreExactAndPositiveZero) {
    for (const std::uint64_t n : {4U, 8U, 240U, 1024U}) {
        EXPECT_EQ(cos_sin_turn(n / 4, n).cos, 0);
        EXPECT_EQ(cos_sin_turn(n / 4, n).sin, 1);
        EXPECT_EQ(cos_sin_turn(n / 2, n).cos, -1);
        EXPECT_EQ(cos_sin_turn(n / 2, n).sin, 0);
        EXPECT_EQ(cos_sin_turn(3 * n / 4, n).cos, 0);
        EXPECT_EQ(cos_sin_turn(3 * n / 4, n).sin, -1);
        for (std::uint64_t q = 0; q < 4; ++q) {
            EXPECT_FALSE(std::signbit(cos_sin_turn(q * n / 4, n).cos) && q != 2);
            EXPECT_FALSE(std::signbit(cos_sin_turn(q * n / 4, n).sin) && q != 3);
        }
    }
}

TEST(UnitCircle, IsExactlySymmetric) {
    const std::uint64_t n = 8 * 37;
    for (std::uint64_t i = 0; i < n; ++i) {
        const CosSin v = cos_sin_turn(i, n);
        const CosSin quarter = cos_sin_turn(i + n / 4, n);
        const CosSin mirror = cos_sin_turn(n / 4 + n - i, n);
        EXPECT_EQ(quarter.cos, -v.sin);
        EXPECT_EQ(quarter.sin, v.cos);
        EXPECT_EQ(mirror.cos, v.sin);
        EXPECT_EQ(mirror.sin, v.cos);
    }
    EXPECT_EQ(cos_sin_turn(1, 8).cos, cos_sin_turn(1, 8).sin);
}

TEST(UnitCircle, TakesTurnsNearTheEndOfTheIntegers) {
    const std::uint64_t n = ~std::uint64_t{0};
    EXPECT_NEAR(cos_sin_turn(n / 3, n).cos, -0.5, 1e-15);
    EXPECT_NEAR(cos_sin_turn(n - 1, n).sin, 0, 1e-15);
}

TEST(UnitCircle, DegreesAgreeWithTurns) {
    for (int d = -720; d <= 720; ++d) {
        const CosSin v = cos_sin_degrees(d);
        const CosSin t = cos_sin_turn(static_cast<std::uint64_t>(d + 720), 360);
        EXPECT_NEAR(v.cos, t.cos, 2e-16) << d;
        EXPECT_NEAR(v.sin, t.sin, 2e-16) << d;
    }
    EXPECT_EQ(cos_sin_degrees(-1e-300).cos, 1);
    EXPECT_EQ(cos_sin_degrees(360e9 + 90).sin, 1);
}

TEST(UnitCircle, HasTheSameBitsOnEveryMachine) {
    EXPECT_EQ(std::bit_cast<std::uint64_t>(cos_sin_turn(1, 7).cos), 0x3fe3f3a0e28bedd1ULL);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(cos_sin_turn(1, 7).sin), 0x3fe904c37505de4bULL);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(cos_sin_degrees(33.3).cos), 0x3feabeef145aa617ULL);
    EXPECT_EQ(std::bit_cast<std::uint64_t>(cos_sin_degrees(33.3).sin), 0x3fe191984d01e95bULL);
}

} // namespace
} // namespace lamella
