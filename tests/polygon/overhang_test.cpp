#include "lamella/contour/normal_form.hpp"

#include "fixtures/layers.hpp"
#include "polygon/overhang.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace lamella::overhang_cases {
namespace {

using test::Contour;
using test::normal_layer;
using test::rectangle;
using test::reversed;

Contour circle(double radius) {
    Contour ring;
    constexpr int corners = 720;
    for (int i = 0; i < corners; ++i) {
        const double angle = 2 * std::numbers::pi * i / corners;
        ring.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    return ring;
}

TEST(Overhang, IsNoneWhereTheLayerBelowReaches) {
    const Layer below = normal_layer({rectangle(0, 0, 10, 10)});
    EXPECT_EQ(overhang(normal_layer({rectangle(-1, -1, 11, 11)}), below, 1, 1e-6).bodies, 0U);
    EXPECT_EQ(overhang(normal_layer({rectangle(2, 2, 5, 5)}), below, 1, 1e-6).bodies, 0U);
}

TEST(Overhang, HasTheAreaBeyondTheReach) {
    const Layer below = normal_layer({rectangle(0, 0, 10, 10)});
    const Overhang bar = overhang(normal_layer({rectangle(5, 4, 15, 6)}), below, 1, 1e-6);
    EXPECT_EQ(bar.bodies, 1U);
    EXPECT_NEAR(bar.area_mm2, 8, 1e-9);
    EXPECT_NEAR(bar.width_mm, 5, 1e-9);
    const Overhang both = overhang(normal_layer({rectangle(-4, 4, 13, 6)}), below, 1, 1e-6);
    EXPECT_EQ(both.bodies, 2U);
    EXPECT_NEAR(both.width_mm, 4, 1e-9);
}

TEST(Overhang, IsAsWideInTheMiddleOfALidAsAtItsEnds) {
    const Layer tube = normal_layer({rectangle(-9, -9, 9, 9), reversed(circle(5))});
    const Overhang lid = overhang(normal_layer({rectangle(-9, -9, 9, 9)}), tube, 0.5, 1e-6);
    EXPECT_EQ(lid.bodies, 1U);
    EXPECT_LE(lid.width_mm, 5);
    EXPECT_GE(lid.width_mm, 5 * 0.95);
    const Layer pillars = normal_layer({rectangle(0, 0, 2, 2), rectangle(12, 0, 14, 2)});
    const Overhang bridge = overhang(normal_layer({rectangle(0, 0, 14, 2)}), pillars, 0.5, 1e-6);
    EXPECT_LE(bridge.width_mm, 5 + 1e-9);
    EXPECT_GE(bridge.width_mm, 5 * 0.95);
}

TEST(Overhang, LeavesOutAreasThatAreTooNarrow) {
    const Layer below = normal_layer({rectangle(0, 0, 10, 10)});
    const Layer layer = normal_layer({rectangle(0, 0, 11 + 1e-4, 10)});
    EXPECT_EQ(overhang(layer, below, 1, 1e-3).bodies, 0U);
    EXPECT_EQ(overhang(layer, below, 1, 1e-5).bodies, 1U);
}

} // namespace
} // namespace lamella::overhang_cases
