#include "lamella/contour/measure.hpp"

#include "fixtures/random.hpp"
#include "slices/engine/even_odd_rings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>
#include <vector>

namespace lamella::even_odd_rings_cases {
namespace {

using Ring = std::vector<Point2>;

Ring square(double x, double y, double half) {
    return {{x - half, y - half}, {x + half, y - half}, {x + half, y + half}, {x - half, y + half}};
}

std::optional<std::size_t> direct(std::vector<Ring>& rings) {
    std::vector<std::span<Point2>> spans(rings.begin(), rings.end());
    return direct_by_even_odd(spans);
}

TEST(EvenOddRings, RunAsTheirDepthSaysHoweverTheyAreDrawn) {
    test::Random random(3);
    for (int round = 0; round < 200; ++round) {
        std::vector<Ring> rings;
        std::vector<int> depths;
        for (int tower = 0; tower < 4; ++tower)
            for (int depth = 0; depth < 6; ++depth) {
                Ring ring = square(10.0 * tower, 0, 4.5 - 0.7 * depth);
                if (random.integer(0, 1) == 0)
                    std::reverse(ring.begin(), ring.end());
                std::rotate(ring.begin(), ring.begin() + random.integer(0, 3), ring.end());
                const auto at = random.integer(0, static_cast<std::int64_t>(rings.size()));
                rings.insert(rings.begin() + at, ring);
                depths.insert(depths.begin() + at, depth);
            }
        std::size_t wrong = 0;
        for (std::size_t i = 0; i < rings.size(); ++i)
            wrong += (ring_area(rings[i]) > 0) == (depths[i] % 2 == 0) ? 0 : 1;
        EXPECT_EQ(direct(rings), wrong);
        for (std::size_t i = 0; i < rings.size(); ++i)
            EXPECT_EQ(ring_area(rings[i]) > 0, depths[i] % 2 == 0);
        EXPECT_EQ(direct(rings), 0U);
    }
}

TEST(EvenOddRings, AreLeftAsTheyAreIfTheyAreTooMany) {
    std::vector<Ring> rings;
    for (int i = 0; i < 20'000; ++i)
        rings.push_back(square(0, 0, 1 + 1e-4 * i));
    const std::vector<Ring> before = rings;
    EXPECT_EQ(direct(rings), std::nullopt);
    EXPECT_EQ(rings, before);
}

} // namespace
} // namespace lamella::even_odd_rings_cases
