#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/fill.hpp"

#include "fixtures/rounds.hpp"
#include "polygon/holes_in_material.hpp"
#include "polygon/plain_rings.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <vector>

namespace lamella::holes_in_material_cases {
namespace {

using test::Contour;
using test::diamond;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::reversed;

bool passed(const std::vector<Contour>& rings) {
    return holes_lie_in_material(normal_layer(rings), {});
}

TEST(HolesInMaterial, PassOnlyWhereTheWindingNumberIsThatOfMaterial) {
    Random random(341);
    std::size_t right = 0;
    std::size_t wrong = 0;
    for (int round = 0; round < test::rounds_within_reason(3000); ++round) {
        const Layer layer = normal_layer(test::nested_stars(random));
        bool in_material = true;
        for (std::size_t hole = 0; hole < layer.rings; ++hole) {
            const auto ring = layer.contour(hole);
            if (orientation(ring.back(), ring[0], ring[1]) > 0)
                continue;
            int winding = 0;
            for (std::size_t other = 0; other < layer.rings; ++other)
                winding += other == hole ? 0 : test::plain_winding(layer.contour(other), ring.front());
            in_material = in_material && winding >= 1;
        }
        const bool found = holes_lie_in_material(layer, {});
        EXPECT_EQ(found, in_material) << round << ": nothing of this is undecided";
        ++(found ? right : wrong);
    }
    EXPECT_GT(right, test::slowed ? 0U : 50U);
    EXPECT_GT(wrong, test::slowed ? 0U : 50U);
}

TEST(HolesInMaterial, NeverPassBelowZero) {
    Random random(342);
    std::size_t found = 0;
    for (int round = 0; round < test::rounds_within_reason(2000); ++round) {
        // Rings that touch but do not cross, some of them in the wrong direction.
        std::vector<Contour> rings =
            test::contours(fill(layer_of(test::tangled_rings(random, true)), FillRule::nonzero).layer);
        for (Contour& ring : rings)
            if (random.integer(0, 9) == 0)
                ring = reversed(ring);
        const Layer layer = normal_layer(rings);
        if (!holes_lie_in_material(layer, {}))
            continue;
        ++found;
        for (int i = 0; i < 200; ++i) {
            const Point2 p{random.real(0, 12), random.real(0, 12)};
            EXPECT_GE(test::plain_winding(layer, p), 0) << round;
        }
    }
    EXPECT_GT(found, test::slowed ? 0U : 100U);
}

TEST(HolesInMaterial, PassWithoutHolesAndWithoutRings) {
    EXPECT_TRUE(passed({}));
    EXPECT_TRUE(passed({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6)}));
}

TEST(HolesInMaterial, ArePassedOnWhereTheyAreNotDecidedQuickly) {
    EXPECT_TRUE(passed({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), diamond(4, 4, 2)}));
    EXPECT_FALSE(passed({rectangle(0, 0, 9, 9), reversed(diamond(4, 4, 4))}))
        << "its left end is on the side";
    EXPECT_FALSE(passed({reversed(rectangle(0, 0, 9, 9))}));
    EXPECT_FALSE(
        passed({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), reversed(diamond(4, 4, 2))}));
    EXPECT_FALSE(passed({rectangle(0, 0, 9, 9), reversed(rectangle(5, 5, 12, 8))})) << "it sticks out";
}

} // namespace
} // namespace lamella::holes_in_material_cases
