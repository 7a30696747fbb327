#include "lamella/contour/measure.hpp"
#include "lamella/polygon/crossings.hpp"

#include "fixtures/rounds.hpp"
#include "polygon/boundary.hpp"
#include "polygon/plain_rings.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace lamella::boundary_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;

std::vector<Ring> filled_by(const Layer& layer, FillRule rule) {
    std::vector<std::span<const Point2>> rings;
    for (std::size_t i = 0; i < layer.rings; ++i)
        rings.push_back(layer.contour(i));
    return filled(rings, rule, ClippingGrid(layer.points.span()));
}

bool follows(FillRule rule, int winding) {
    return rule == FillRule::positive  ? winding > 0
           : rule == FillRule::nonzero ? winding != 0
                                       : winding % 2 != 0;
}

TEST(Boundary, WindsOnceAroundTheMaterialOfItsRule) {
    Random random(211);
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        const Layer layer = layer_of(test::tangled_rings(random, round % 2 == 0));
        for (const FillRule rule : {FillRule::positive, FillRule::nonzero, FillRule::evenodd}) {
            const Layer bounds = layer_of(filled_by(layer, rule));
            EXPECT_EQ(find_crossings(bounds).count, 0U) << round;
            EXPECT_NEAR(test::winding_area(bounds, [](int w) { return w == 1; }),
                        test::winding_area(layer, [&](int w) { return follows(rule, w); }), 1e-6)
                << round;
            EXPECT_NEAR(test::winding_area(bounds, [](int w) { return w != 0 && w != 1; }), 0, 1e-6) << round;
        }
    }
}

TEST(Boundary, KeepsTheCoordinatesOfCorners) {
    Random random(212);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        const Contour ring = test::star(random, {random.real(-1, 1), random.real(-1, 1)}, 5);
        const Layer layer = layer_of({ring});
        const std::vector<Ring> bounds = filled_by(layer, FillRule::positive);
        ASSERT_EQ(bounds.size(), 1U);
        for (const Point2& p : bounds.front())
            EXPECT_NE(std::find(ring.begin(), ring.end(), p), ring.end()) << round;
    }
}

TEST(Boundary, OfBodiesThatMeetInAPointKeepsThemApart) {
    const std::vector<Ring> bounds =
        filled_by(layer_of({rectangle(0, 0, 2, 2), rectangle(2, 2, 5, 5)}), FillRule::positive);
    ASSERT_EQ(bounds.size(), 2U);
    for (const Ring& ring : bounds) {
        EXPECT_EQ(ring.size(), 4U);
        EXPECT_GT(ring_area(ring), 0);
    }
    // The corner of the hole lies on the side of its body.
    const std::vector<Ring> frame =
        filled_by(layer_of({rectangle(0, 0, 9, 9), reversed({{0, 4}, {4, 2}, {4, 6}})}), FillRule::positive);
    double area = 0;
    for (const Ring& ring : frame)
        area += ring_area(ring);
    EXPECT_NEAR(area, 81 - 8, 1e-9);
}

TEST(Boundary, OfNoMaterialIsEmpty) {
    EXPECT_TRUE(filled_by(layer_of({reversed(rectangle(0, 0, 2, 2))}), FillRule::positive).empty());
    EXPECT_TRUE(
        filled_by(layer_of({rectangle(0, 0, 2, 2), rectangle(0, 0, 2, 2)}), FillRule::evenodd).empty());
    EXPECT_TRUE(filled_by(layer_of({{{0, 0}, {3, 3}}}), FillRule::nonzero).empty());
}

} // namespace
} // namespace lamella::boundary_cases
