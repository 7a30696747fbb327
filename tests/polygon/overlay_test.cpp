#include "lamella/contour/measure.hpp"
#include "lamella/polygon/crossings.hpp"

#include "fixtures/rounds.hpp"
#include "polygon/overlay.hpp"
#include "polygon/plain_rings.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace lamella::overlay_cases {
namespace {

using test::Contour;
using test::contours;
using test::diamond;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::reversed;

std::size_t number_of(const std::vector<Fate>& fates, Fate fate) {
    return static_cast<std::size_t>(std::count(fates.begin(), fates.end(), fate));
}

TEST(Overlay, FillsTheAreaOfEachRule) {
    Random random(221);
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        const Layer layer = normal_layer(test::tangled_rings(random, round % 2 == 0));
        const Overlay overlay(layer);
        for (const auto& [rule, follows] : {std::pair<FillRule, bool (*)(int)>{FillRule::positive,
                                                                               [](int w) {
                                                                                   return w > 0;
                                                                               }},
                                            {FillRule::nonzero,
                                             [](int w) {
                                                 return w != 0;
                                             }},
                                            {FillRule::evenodd, [](int w) {
                                                 return w % 2 != 0;
                                             }}})
            for (const Walls walls : {Walls::left, Walls::dissolved}) {
                const Overlaid overlaid = overlay.filled(Material(rule), walls);
                EXPECT_NEAR(measure(overlaid.filled.layer).area_mm2, test::winding_area(layer, follows), 1e-6)
                    << round;
                EXPECT_EQ(find_crossings(overlaid.filled.layer).count, 0U) << round;
            }
    }
}

TEST(Overlay, CombinesTwoOperands) {
    Random random(222);
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        const std::vector<Contour> first = test::tangled_rings(random, round % 2 == 0);
        const std::vector<Contour> second = test::tangled_rings(random, round % 2 == 0);
        std::vector<Contour> both = first;
        both.insert(both.end(), second.begin(), second.end());
        const Layer layer = layer_of(both);
        std::vector<Windings> turns(first.size(), {1, 0});
        turns.resize(both.size(), {0, 1});
        const Overlay overlay(layer, turns, {});
        const auto expect = [&](BooleanOperation operation, bool (*made)(bool, bool)) {
            EXPECT_NEAR(measure(overlay.filled(Material(operation), Walls::dissolved).filled.layer).area_mm2,
                        test::winding_area(layer_of(first), layer_of(second),
                                           [&](int a, int b) { return made(a > 0, b > 0); }),
                        1e-6)
                << round;
        };
        expect(BooleanOperation::unite, [](bool a, bool b) { return a || b; });
        expect(BooleanOperation::intersect, [](bool a, bool b) { return a && b; });
        expect(BooleanOperation::subtract, [](bool a, bool b) { return a && !b; });
        expect(BooleanOperation::exclude, [](bool a, bool b) { return a != b; });
    }
}

TEST(Overlay, HasAFateForEachRing) {
    Random random(223);
    std::size_t kept = 0;
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        std::vector<Contour> rings = test::nested_stars(random);
        if (round % 3 == 0)
            for (const Contour& ring : test::tangled_rings(random, true))
                rings.push_back(ring);
        const Layer layer = normal_layer(rings);
        const Overlaid overlaid = Overlay(layer).filled(Material(FillRule::positive));
        const Filled& filled = overlaid.filled;
        ASSERT_EQ(overlaid.fates.size(), layer.rings);
        EXPECT_EQ(number_of(overlaid.fates, Fate::dropped), filled.rings_dropped) << round;
        EXPECT_EQ(number_of(overlaid.fates, Fate::reversed), filled.rings_reversed) << round;
        EXPECT_EQ(number_of(overlaid.fates, Fate::united), filled.rings_united) << round;
        const std::vector<Contour> left = contours(filled.layer);
        for (std::size_t i = 0; i < layer.rings; ++i)
            if (overlaid.fates[i] == Fate::kept) {
                const Contour ring(layer.contour(i).begin(), layer.contour(i).end());
                EXPECT_NE(std::find(left.begin(), left.end(), ring), left.end()) << round;
                ++kept;
            }
        if (filled.groups_united == 0) {
            EXPECT_EQ(left.size(),
                      number_of(overlaid.fates, Fate::kept) + number_of(overlaid.fates, Fate::reversed))
                << round;
        }
    }
    EXPECT_GT(kept, test::slowed ? 0U : 100U);
}

TEST(Overlay, IsCleanWithoutContactsWhereEachRingBoundsMaterial) {
    const auto clean = [](const std::vector<Contour>& rings) {
        const Layer layer = layer_of(rings);
        return Overlay(layer).clean();
    };
    EXPECT_TRUE(clean({}));
    EXPECT_TRUE(clean({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), diamond(4, 4, 2)}));
    EXPECT_FALSE(clean({rectangle(0, 0, 9, 9), rectangle(1, 1, 8, 8)})) << "the inner body overlaps";
    EXPECT_FALSE(clean({rectangle(0, 0, 9, 9), rectangle(9, 9, 12, 12)})) << "they touch";
    EXPECT_FALSE(clean({reversed(rectangle(0, 0, 9, 9))}));
    Random random(224);
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        const Layer layer = normal_layer(test::nested_stars(random));
        if (Overlay(layer).clean()) {
            EXPECT_EQ(test::winding_area(layer, [](int w) { return w < 0 || w > 1; }), 0) << round;
            EXPECT_EQ(united(layer).points.data(), layer.points.data()) << "not even copied";
        }
    }
}

TEST(Overlay, DissolvesWallsIfWanted) {
    const Layer layer = normal_layer({rectangle(0, 0, 2, 2), rectangle(2, 0, 4, 2)});
    const Overlay overlay(layer);
    EXPECT_EQ(overlay.filled(Material(FillRule::positive), Walls::left).filled.layer.rings, 2U);
    EXPECT_EQ(overlay.filled(Material(FillRule::positive), Walls::dissolved).filled.layer.rings, 1U);
}

TEST(Overlay, HasTheBoxOfAllRings) {
    const Layer layer = layer_of({rectangle(3, 1, 9, 9), rectangle(-2, 4, 0, 12)});
    const Box2 box = Overlay(layer).box();
    EXPECT_EQ(box.x0, -2);
    EXPECT_EQ(box.y0, 1);
    EXPECT_EQ(box.x1, 9);
    EXPECT_EQ(box.y1, 12);
}

} // namespace
} // namespace lamella::overlay_cases
