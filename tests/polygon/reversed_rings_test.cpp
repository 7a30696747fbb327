#include "fixtures/rounds.hpp"
#include "polygon/plain_rings.hpp"
#include "polygon/reversed_rings.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(ReversedRings, HaveMaterialWhereTheWindingNumberWasNegative) {
    test::Random random(241);
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        Layer layer = test::layer_of(test::tangled_rings(random, false), {{{1, 1}, {2, 2}}});
        layer.index = 7;
        layer.z = 0.5;
        const Layer reversed = with_rings_reversed(layer);
        EXPECT_EQ(reversed.contours(), layer.rings) << "chains are left out";
        EXPECT_EQ(reversed.index, 7U);
        EXPECT_EQ(reversed.z, 0.5);
        EXPECT_NEAR(test::winding_area(reversed, [](int w) { return w > 0; }),
                    test::winding_area(layer, [](int w) { return w < 0; }), 1e-9)
            << round;
    }
}

} // namespace
} // namespace lamella
