#include "lamella/contour/measure.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/inverted_rings.hpp"

#include "fixtures/layers.hpp"
#include "polygon/holes_in_material.hpp"
#include "winding_areas.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

namespace lamella::inverted_cases {
namespace {

using test::Contour;
using test::diamond;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::regular_polygon;
using test::reversed;

Contour moved(Contour ring, double x, double y) {
    for (Point2& p : ring)
        p = {p.x + x, p.y + y};
    return ring;
}

double lost_area(const Layer& layer) {
    return test::winding_area(layer, [](int winding) { return winding < 0; });
}

TEST(InvertedRings, AreNoneOfBodiesWithHolesAndBodiesInThese) {
    EXPECT_EQ(inverted_rings(Layer{}), InvertedRings{});
    const Layer layer =
        normal_layer({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), rectangle(2, 2, 7, 7),
                      reversed(diamond(4, 4, 1)), rectangle(20, 0, 30, 5)});
    EXPECT_TRUE(holes_lie_in_material(layer, {}));
    EXPECT_EQ(inverted_rings(layer), InvertedRings{});
    EXPECT_EQ(inverted_rings(layer, {}, InversionSearch::full), InvertedRings{});
}

TEST(InvertedRings, AreNoneOfRingsThatCancel) {
    const Contour ring = rectangle(0, 0, 10, 10);
    const Contour more = rectangle(20, 0, 30, 10);
    Contour near = reversed(ring); // but for the last digits
    for (Point2& p : near)
        p = {p.x * (1 - 0x1p-52), p.y * (1 - 0x1p-52)};
    for (const InversionSearch search : {InversionSearch::quick, InversionSearch::full}) {
        EXPECT_EQ(inverted_rings(normal_layer({ring, reversed(ring)}), {}, search), InvertedRings{});
        EXPECT_EQ(inverted_rings(normal_layer({ring, near}), {}, search), InvertedRings{});
        EXPECT_EQ(inverted_rings(normal_layer({reversed(near), reversed(ring)}), {}, search),
                  InvertedRings{});
        EXPECT_EQ(inverted_rings(normal_layer({ring, reversed(ring), more, reversed(more)}), {}, search),
                  InvertedRings{});
        const Layer two = normal_layer({ring, reversed(ring), reversed(ring)});
        EXPECT_EQ(inverted_rings(two, {}, search).rings, 1U);
        EXPECT_EQ(inverted_rings(two, {}, search).area_mm2, 100);
    }
    EXPECT_EQ(fill(normal_layer({ring, reversed(ring)}), FillRule::positive).layer.rings, 0U);
}

TEST(InvertedRings, AreCountedWhereverTheyStand) {
    for (const double x : {-20.0, 20.0}) {
        const Layer layer = normal_layer({rectangle(0, 0, 10, 10), reversed(diamond(4, 4, 1)),
                                          moved(reversed(rectangle(0, 0, 6, 6)), x, 0)});
        const InvertedRings found = inverted_rings(layer);
        EXPECT_EQ(found.rings, 1U);
        EXPECT_EQ(found.area_mm2, 36);
        EXPECT_EQ(found.at, (Point2{x, 0}));
    }
}

TEST(InvertedRings, OfAHollowBodyAreBothOfItsRings) {
    const InvertedRings found =
        inverted_rings(normal_layer({reversed(rectangle(0, 0, 9, 9)), rectangle(1, 1, 8, 8)}));
    EXPECT_EQ(found.rings, 2U);
    EXPECT_EQ(found.area_mm2, 81 - 49);
}

TEST(InvertedRings, AreFoundInAHoleAndBesideOneThatEndsWhereTheyBegin) {
    EXPECT_EQ(inverted_rings(normal_layer({rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)),
                                           reversed(rectangle(2, 2, 4, 4))}))
                  .area_mm2,
              4);
    EXPECT_EQ(
        inverted_rings(normal_layer({rectangle(0, 0, 9, 9), reversed(rectangle(9, 2, 12, 5))})).area_mm2, 9);
}

TEST(InvertedRings, AreFoundInASpikeOfAHoleOfManyPoints) {
    Random random(14);
    for (int round = 0; round < 200; ++round) {
        // A round hole; one of its many sides is a spike of two points, at a random place.
        const std::int64_t corners = random.integer(100, 400);
        const std::int64_t spike = random.integer(0, corners - 1);
        Contour hole;
        Point2 tip;
        for (std::int64_t i = 0; i < corners; ++i) {
            const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
            const Point2 on{10 * std::cos(angle), 10 * std::sin(angle)};
            hole.push_back(on);
            if (i == spike) {
                tip = {3 * on.x, 3 * on.y};
                hole.push_back(tip);
            }
        }
        // In the middle of the spike, which is 0.09 mm wide or more there.
        const double aside = 0.3 * 2 * std::sin(std::numbers::pi / static_cast<double>(corners)) / 3;
        const Point2 inside{0.6 * tip.x - aside * tip.y, 0.6 * tip.y + aside * tip.x};
        const Layer layer = normal_layer(
            {rectangle(-50, -50, 50, 50), reversed(hole), reversed(diamond(inside.x, inside.y, 0.005))});
        EXPECT_EQ(inverted_rings(layer).rings, 1U) << "round " << round;
    }
}

TEST(InvertedRings, AreNoneWhereHolesTouchTheRingAroundThem) {
    for (const Contour& hole :
         {rectangle(0, 2, 3, 5), rectangle(3, 0, 5, 2), rectangle(6, 6, 9, 9), diamond(2, 4, 2)})
        EXPECT_EQ(inverted_rings(normal_layer({rectangle(0, 0, 9, 9), reversed(hole)})), InvertedRings{});
}

TEST(InvertedRings, OfARingThatCrossesItselfAreItsClockwisePart) {
    const Layer bow_tie = normal_layer({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}});
    const InvertedRings found = inverted_rings(bow_tie, {}, InversionSearch::full);
    EXPECT_EQ(found.rings, 1U);
    EXPECT_NEAR(found.area_mm2, 25, 1e-9);
}

TEST(InvertedRings, ThatReachOutOfTheMaterialAroundTheirLeftEndsAreFound) {
    const Layer layer = normal_layer({rectangle(0, 0, 10, 10), reversed(rectangle(5, 5, 15, 8))});
    EXPECT_NEAR(inverted_rings(layer).area_mm2, 15, 1e-9);
}

TEST(InvertedRings, ThinnerThanTheRoundingDoNotCount) {
    const Contour sliver = reversed(rectangle(100, 0, 110, 1e-6));
    EXPECT_EQ(inverted_rings(normal_layer({rectangle(0, 0, 9, 9), sliver})), InvertedRings{});
    const Contour thin = reversed(rectangle(100, 0, 110, 1e-3));
    EXPECT_EQ(inverted_rings(normal_layer({rectangle(0, 0, 9, 9), thin})).rings, 1U);
    EXPECT_EQ(inverted_rings(normal_layer({rectangle(0, 0, 9, 9), thin}), {.step_mm = 0.01}).rings, 0U);
}

/// Rings in rows and columns, within one another, upright and reversed, that do not meet.
Layer random_nesting(Random& random) {
    std::vector<Contour> rings;
    const std::int64_t columns = random.integer(1, 5);
    const std::int64_t rows = random.integer(1, 5);
    if (random.integer(0, 3) != 0)
        rings.push_back(
            rectangle(-1, -1, 10.0 * static_cast<double>(columns), 10.0 * static_cast<double>(rows)));
    for (std::int64_t column = 0; column < columns; ++column)
        for (std::int64_t row = 0; row < rows; ++row)
            for (std::int64_t depth = random.integer(0, 3); depth > 0; --depth) {
                Contour ring =
                    moved(regular_polygon(static_cast<int>(random.integer(3, 12)),
                                          4.0 / static_cast<double>(1 << (2 * depth)) * 4),
                          10.0 * static_cast<double>(column) + 4.5, 10.0 * static_cast<double>(row) + 4.5);
                rings.push_back(random.integer(0, 1) == 0 ? reversed(ring) : ring);
            }
    return normal_layer(rings);
}

TEST(InvertedRings, EncloseWhereTheWindingNumberIsNegative) {
    Random random(11);
    int sound = 0;
    for (int round = 0; round < 400; ++round) {
        const Layer layer = random_nesting(random);
        const double lost = lost_area(layer);
        EXPECT_NEAR(inverted_rings(layer).area_mm2, lost, 1e-9);
        EXPECT_NEAR(inverted_rings(layer, {}, InversionSearch::full).area_mm2, lost, 1e-9);
        EXPECT_EQ(holes_lie_in_material(layer, {}), lost == 0) << "round " << round;
        sound += lost == 0 ? 1 : 0;
    }
    EXPECT_GT(sound, 40);
    EXPECT_LT(sound, 360);
}

TEST(InvertedRings, EncloseWhereTheWindingNumberIsNegativeThoughRingsTouchAndCross) {
    Random random(12);
    for (int round = 0; round < 400; ++round) {
        std::vector<Contour> rings;
        for (std::int64_t count = random.integer(1, 6); count > 0; --count) {
            Contour ring;
            for (std::int64_t points = random.integer(3, 6); points > 0; --points)
                ring.push_back(
                    {static_cast<double>(random.integer(0, 8)), static_cast<double>(random.integer(0, 8))});
            rings.push_back(ring);
        }
        const Layer layer = normal_layer(rings);
        EXPECT_NEAR(inverted_rings(layer, {}, InversionSearch::full).area_mm2, lost_area(layer), 1e-6);
    }
}

TEST(InvertedRings, ArePassedOverByTheQuickLookOnlyWhereRingsCross) {
    Random random(13);
    int passed = 0;
    for (int round = 0; round < 2000; ++round) {
        std::vector<Contour> rings;
        for (std::int64_t count = random.integer(2, 7); count > 0; --count) {
            const auto x = static_cast<double>(random.integer(0, 6));
            const auto y = static_cast<double>(random.integer(0, 6));
            const Contour ring = rectangle(x, y, x + static_cast<double>(random.integer(1, 7)),
                                           y + static_cast<double>(random.integer(1, 7)));
            rings.push_back(random.integer(0, 1) == 0 ? reversed(ring) : ring);
        }
        const Layer layer = normal_layer(rings);
        if (!holes_lie_in_material(layer, {}))
            continue;
        ++passed;
        // The winding number just left of each left end, by the oracle: a strip that touches nothing else.
        for (std::size_t i = 0; i < layer.rings; ++i) {
            if (ring_area(layer.contour(i)) > 0)
                continue;
            const Point2 p = layer.contour(i).front();
            EXPECT_EQ(test::winding_area(layer,
                                         normal_layer({rectangle(p.x - 0.5, p.y + 0.25, p.x, p.y + 0.75)}),
                                         [](int winding, int strip) { return strip > 0 && winding < 1; }),
                      0)
                << "round " << round;
        }
    }
    EXPECT_GT(passed, 100);
}

} // namespace
} // namespace lamella::inverted_cases
