#include "contour/distance.hpp"
#include "fixtures/random.hpp"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdint>

namespace lamella {
namespace {

TEST(Hypotenuse, IsThatOfPythagoras) {
    EXPECT_EQ(hypotenuse(0, 0), 0);
    EXPECT_EQ(hypotenuse(-0.1, 0), 0.1);
    EXPECT_EQ(hypotenuse(0, -1e-300), 1e-300);
    for (const double unit : {1.0, 1e-300, 1e-6, 1e300})
        EXPECT_DOUBLE_EQ(hypotenuse(-3 * unit, 4 * unit), 5 * unit);
    test::Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const double dx = random.real(-10, 10);
        const double dy = random.real(-10, 10);
        EXPECT_DOUBLE_EQ(hypotenuse(dx, dy), std::hypot(dx, dy));
        EXPECT_EQ(hypotenuse(dx, dy), hypotenuse(-dy, dx));
    }
}

TEST(Hypotenuse, HasTheSameBitsOnEveryProcessor) {
    test::Random random(2);
    std::uint64_t all = 0;
    for (int i = 0; i < 1000; ++i)
        all = all * 31 + std::bit_cast<std::uint64_t>(hypotenuse(random.real(-10, 10), 7));
    EXPECT_EQ(all, 0xa7265a7e644a54deU);
}

} // namespace
} // namespace lamella
