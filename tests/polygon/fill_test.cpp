#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/nesting.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::Contour;
using test::contours;
using test::diamond;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::reversed;

constexpr std::array<FillRule, 3> rules{FillRule::nonzero, FillRule::evenodd, FillRule::positive};

bool is_material(FillRule rule, int winding) {
    return rule == FillRule::nonzero   ? winding != 0
           : rule == FillRule::evenodd ? winding % 2 != 0
                                       : winding > 0;
}

Layer united(const std::vector<Contour>& rings, FillRule rule = FillRule::nonzero) {
    return fill(normal_layer(rings), rule).layer;
}

TEST(Fill, LeavesBoundariesOfMaterialAlone) {
    const std::vector<std::vector<Contour>> layers{
        {},
        {rectangle(0, 0, 9, 9)},
        {rectangle(0, 0, 9, 9), reversed(rectangle(1, 1, 8, 8)), rectangle(2, 2, 7, 7),
         rectangle(10, 0, 12, 5)},
        // Corner on corner, corner on edge, back to back, a hole that touches its body, a ring that touches
        // itself, and a body that fills a hole.
        {rectangle(0, 0, 2, 2), rectangle(2, 2, 4, 4)},
        {rectangle(0, 0, 2, 2), diamond(3, 1, 1)},
        {rectangle(0, 0, 2, 2), rectangle(2, 1, 4, 9)},
        {rectangle(0, 0, 8, 8), reversed(diamond(4, 4, 4))},
        {{{0, 0}, {4, 0}, {2, 2}, {4, 4}, {0, 4}, {2, 2}}},
        {rectangle(0, 0, 8, 8), reversed(rectangle(2, 2, 4, 4)), rectangle(2, 2, 4, 4)},
    };
    for (const FillRule rule : rules)
        for (const auto& rings : layers) {
            const Layer layer = normal_layer(rings, {{{0, 1}, {7, 7}}});
            const Filled filled = fill(layer, rule);
            EXPECT_FALSE(filled.changed());
            EXPECT_EQ(filled.layer.points.data(), layer.points.data()); // not even copied
            EXPECT_TRUE(same_contours(filled.layer, layer));
        }
}

TEST(Fill, UnitesBodiesThatCross) {
    const Layer layer = normal_layer({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6), rectangle(8, 0, 9, 1)});
    const Filled filled = fill(layer, FillRule::nonzero);
    EXPECT_EQ(filled.groups_united, 1U);
    EXPECT_EQ(filled.rings_united, 2U);
    EXPECT_EQ(contours(filled.layer),
              (std::vector<Contour>{{{0, 0}, {4, 0}, {4, 2}, {6, 2}, {6, 6}, {2, 6}, {2, 4}, {0, 4}},
                                    rectangle(8, 0, 9, 1)}));
    EXPECT_EQ(measure(fill(layer, FillRule::evenodd).layer).area_mm2, 25);
}

TEST(Fill, DropsOrTurnsRingsWithinOthersAsTheyAre) {
    const Contour outer = rectangle(0, 0, 9, 9);
    const Contour inner = diamond(4, 4, 0.3);
    EXPECT_EQ(contours(united({outer, inner})), (std::vector<Contour>{outer}));
    EXPECT_EQ(contours(united({outer, inner}, FillRule::evenodd)),
              contours(normal_layer({outer, reversed(inner)})));
    EXPECT_EQ(contours(united({reversed(outer)})), (std::vector<Contour>{outer}));
    EXPECT_EQ(contours(united({reversed(outer)}, FillRule::positive)), std::vector<Contour>{});
    const Filled turned = fill(normal_layer({reversed(outer), inner}), FillRule::nonzero);
    EXPECT_EQ(turned.groups_united, 0U);
    EXPECT_EQ(turned.rings_reversed, 2U);
    EXPECT_EQ(contours(turned.layer), contours(normal_layer({outer, reversed(inner)})));
}

TEST(Fill, UnitesWhatOverlapsAlsoWithoutCrossingProperly) {
    // Along common edges, through each other's corners, and one body stored twice.
    EXPECT_EQ(contours(united({rectangle(0, 0, 4, 4), rectangle(2, 0, 6, 4)})).size(), 1U);
    EXPECT_EQ(measure(united({rectangle(0, 0, 4, 4), rectangle(2, 0, 6, 4)})).area_mm2, 24);
    const Contour lying{{-4, 0}, {-1, -1}, {1, -1}, {4, 0}, {1, 1}, {-1, 1}};
    const Contour standing{{0, -4}, {1, -1}, {1, 1}, {0, 4}, {-1, 1}, {-1, -1}};
    EXPECT_EQ(find_crossings(layer_of({lying, standing})).count, 0U);
    EXPECT_EQ(measure(united({lying, standing})).area_mm2, 4 + 4 * 3);
    EXPECT_EQ(contours(united({diamond(0, 0, 3), diamond(0, 0, 3)})),
              (std::vector<Contour>{diamond(0, 0, 3)}));
}

TEST(Fill, UnitesRingsThatFoldAtTheirLeftEndWithTheirReverse) {
    // In the fold of one of the two, where it bounds nothing, the other one has its left end.
    const Contour folded{{4, 2}, {7, 2}, {4, 2}, {10, 8}, {6, 2}, {12, 2}, {6, 7}};
    const Layer layer =
        normal_layer({folded, reversed(folded), rectangle(5, 3, 8, 5), rectangle(7, 4, 9, 6)});
    EXPECT_NEAR(measure(fill(layer, FillRule::positive).layer).area_mm2, 9, 1e-6);
    EXPECT_NEAR(measure(fill(layer, FillRule::nonzero).layer).area_mm2, 9, 1e-6);
}

TEST(Fill, CountsTheMaterialAroundAGroup) {
    // Two bodies that cross, in a body, in a hole, in one turned inside out, and in two bodies.
    const Contour a = rectangle(2, 2, 4, 4);
    const Contour b = rectangle(3, 3, 5, 5);
    const Contour frame = rectangle(0, 0, 9, 9);
    EXPECT_EQ(contours(united({a, b, frame})), (std::vector<Contour>{frame}));
    EXPECT_EQ(measure(united({a, b, reversed(frame), rectangle(-1, -1, 10, 10)})).area_mm2, 121 - 81 + 7);
    EXPECT_EQ(measure(united({a, b, reversed(frame)})).area_mm2, 81 - 6); // w = -1 + 2 in the middle is 1
    EXPECT_EQ(measure(united({reversed(a), reversed(b), frame})).area_mm2, 81 - 6);
    EXPECT_EQ(measure(united({reversed(a), reversed(b), frame}, FillRule::positive)).area_mm2, 81 - 7);
    EXPECT_EQ(measure(united({a, b, frame}, FillRule::evenodd)).area_mm2, 81 - 6);
    EXPECT_EQ(measure(united({a, b, frame, rectangle(1, 1, 8, 8)}, FillRule::evenodd)).area_mm2, 81 - 49 + 6);
    std::vector<Contour> many(9, frame);
    for (std::size_t i = 0; i < many.size(); ++i)
        many[i] = rectangle(-1.0 * static_cast<double>(i), -1, 9 + 1.0 * static_cast<double>(i), 9);
    many.push_back(a);
    many.push_back(b);
    EXPECT_EQ(measure(united(many)).area_mm2, 250);
}

TEST(Fill, KeepsChainsAndDropsFlatRings) {
    const Contour chain{{1, 1}, {20, 3}};
    const Filled filled = fill(normal_layer({rectangle(0, 0, 9, 9), {{20, 20}, {25, 25}, {22, 22}}}, {chain}),
                               FillRule::nonzero);
    EXPECT_EQ(filled.rings_dropped, 1U);
    EXPECT_EQ(contours(filled.layer), (std::vector<Contour>{rectangle(0, 0, 9, 9), chain}));
}

/// Rings of a few corners here and there, some of them turned, some of them twice.
std::vector<Contour> random_rings(Random& random, double range, double size, std::int64_t most,
                                  bool integers) {
    std::vector<Contour> rings;
    for (std::int64_t c = random.integer(1, most); c > 0; --c) {
        const double x = random.real(0, range);
        const double y = random.real(0, range);
        Contour ring;
        for (std::int64_t i = random.integer(3, 8); i > 0; --i) {
            Point2 p{x + random.real(0, size), y + random.real(0, size)};
            if (integers)
                p = {std::round(p.x), std::round(p.y)};
            ring.push_back(p);
        }
        const double area = ring_area(ring);
        if (area < 0 && random.integer(0, 3) != 0)
            ring = reversed(ring);
        rings.push_back(ring);
        if (random.integer(0, 9) == 0)
            rings.push_back(ring);
    }
    return rings;
}

void expect_filled(const Layer& layer, FillRule rule, double extent) {
    const Filled filled = fill(layer, rule);
    const double expected =
        test::winding_area(layer, [&](int winding) { return is_material(rule, winding); });
    const double perimeter = measure(layer).perimeter_mm;
    const double tolerance = 4 * perimeter * extent * 0x1p-35 + 1e-12 * extent * extent;
    EXPECT_NEAR(measure(filled.layer).area_mm2, expected, tolerance);
    EXPECT_TRUE(in_normal_form(filled.layer));
    EXPECT_EQ(find_crossings(filled.layer).count, 0U);
    // Its winding number is 0 or 1: what is more, or less, has no area.
    EXPECT_NEAR(test::winding_area(filled.layer, [](int winding) { return winding > 1; }), 0, tolerance);
    EXPECT_NEAR(test::winding_area(filled.layer, [](int winding) { return winding < 0; }), 0, tolerance);
    const Filled again = fill(filled.layer, rule);
    EXPECT_FALSE(again.changed());
    EXPECT_TRUE(same_contours(again.layer, filled.layer));
}

TEST(Fill, GivesTheAreaOfItsRuleForRandomRings) {
    Random random(31);
    for (int round = 0; round < test::rounds_within_reason(1500); ++round) {
        const bool integers = round % 2 == 0; // touches and common edges, or crossings in general position
        const double size = integers ? 8 : round % 3 == 0 ? 60 : 25;
        const Layer layer =
            normal_form(layer_of(random_rings(random, integers ? 16 : 100, size, 12, integers)));
        for (const FillRule rule : rules) {
            expect_filled(layer, rule, 200);
            if (testing::Test::HasFailure())
                FAIL() << "round " << round << ' ' << fill_rule_name(rule);
        }
    }
}

TEST(Fill, KeepsWhatDoesNotOverlapBitForBit) {
    Random random(32);
    std::size_t kept = 0;
    for (int round = 0; round < 300; ++round) {
        std::vector<Contour> rings = random_rings(random, 100, 8, 40, false);
        const Layer layer = normal_form(layer_of(rings));
        const Nesting nest = nesting(layer);
        const std::vector<Contour> filled = contours(fill(layer, FillRule::nonzero).layer);
        const std::set<Contour> result(filled.begin(), filled.end());
        const std::vector<Contour> before = contours(layer);
        for (std::size_t i = 0; i < before.size(); ++i) {
            bool apart = nest.kind[i] == RingKind::outer && find_crossings(layer_of({before[i]})).count == 0;
            for (std::size_t j = 0; apart && j < before.size(); ++j)
                apart = i == j || (find_crossings(layer_of({before[i], before[j]})).count ==
                                       find_crossings(layer_of({before[j]})).count &&
                                   before[i] != before[j]);
            if (!apart)
                continue;
            EXPECT_TRUE(result.contains(before[i])) << round;
            ++kept;
        }
    }
    EXPECT_GT(kept, 1000U);
}

TEST(Fill, DoesNotDependOnPlaceAndScaleBeyondRounding) {
    Random random(33);
    const std::vector<Contour> rings = random_rings(random, 100, 40, 30, false);
    const Layer layer = normal_layer(rings);
    const double area = measure(fill(layer, FillRule::nonzero).layer).area_mm2;
    for (const double scale : {0x1p-400, 1e-6, 1e3, 0x1p400})
        for (const double shift : {0.0, 1000.0}) {
            std::vector<Contour> moved = rings;
            for (Contour& ring : moved)
                for (Point2& p : ring)
                    p = {(p.x + shift) * scale, (p.y - shift) * scale};
            const Layer result = united(moved);
            EXPECT_NEAR(measure(result).area_mm2 / scale / scale, area, 1e-6 * area) << scale << ' ' << shift;
        }
}

TEST(Fill, IsRightWhereSidesRunBesideOneAnotherForLong) {
    // A ring that folds back by 0.02 mm, in units of the grid: rounded to it, the sides cross again one unit
    // further, and again.
    const Contour folded{{-46515776756, -11909104958},
                         {-45071908681, -13153808872},
                         {-45072286567, -13153483111},
                         {-44291582251, -13720388620},
                         {0, -13720388620},
                         {0, 40000000000},
                         {-72000000000, 40000000000}};
    for (const double turn : {1, -1})
        for (const bool mirrored : {false, true}) {
            Contour ring;
            for (const Point2& p : folded) {
                const Point2 at{p.x * 0x1p-34, p.y * turn * 0x1p-34};
                ring.push_back(mirrored ? Point2{at.y, at.x} : at);
            }
            if ((turn < 0) != mirrored)
                std::reverse(ring.begin(), ring.end());
            const Layer layer = normal_layer({ring});
            ASSERT_TRUE(has_crossings(layer));
            for (const FillRule rule : rules) {
                const Layer filled = fill(layer, rule).layer;
                EXPECT_NEAR(measure(filled).area_mm2, measure(layer).area_mm2, 1e-8);
                EXPECT_FALSE(has_crossings(filled));
                EXPECT_FALSE(fill(filled, rule).changed());
            }
        }
}

TEST(Fill, IsRightWhereAllSidesRunThroughOnePlace) {
    constexpr int bars = 40;
    constexpr double half_width = 0.5;
    constexpr double reach = 100;
    for (const Point2& centre : {Point2{0, 0}, Point2{5000, -3000}}) {
        std::vector<Contour> rings;
        for (int i = 0; i < bars; ++i) {
            const double angle = std::numbers::pi * (i + 0.25) / bars;
            const Point2 along{reach * std::cos(angle), reach * std::sin(angle)};
            const Point2 across{-half_width * std::sin(angle), half_width * std::cos(angle)};
            Contour& ring = rings.emplace_back();
            for (const auto& [a, b] :
                 {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)})
                ring.push_back(
                    {centre.x + a * along.x + b * across.x, centre.y + a * along.y + b * across.y});
        }
        const Layer star = united(rings);
        EXPECT_EQ(star.rings, 1U);
        EXPECT_EQ(star.points.size(), 3U * 2 * bars); // the ends of each arm, and where it meets the next one
        EXPECT_FALSE(has_crossings(star));
        const double intersection = half_width / std::tan(std::numbers::pi / bars / 2);
        EXPECT_NEAR(measure(star).area_mm2, 2 * bars * half_width * (2 * reach - intersection), 1e-4);
        std::reverse(rings.begin(), rings.end());
        EXPECT_TRUE(same_contours(united(rings), star));
    }
}

/// Rectangles around one another whose lower sides lie on one line, which is turned by an angle.
std::vector<Contour> nested_on_a_line(int count, double angle) {
    std::vector<Contour> rings;
    for (int i = 1; i <= count; ++i) {
        Contour& ring = rings.emplace_back();
        for (const Point2& p : rectangle(-i, 0, i, i))
            ring.push_back({p.x * std::cos(angle) - p.y * std::sin(angle),
                            p.x * std::sin(angle) + p.y * std::cos(angle)});
    }
    return rings;
}

TEST(Fill, AddsUpSidesOnOneLine) {
    constexpr int count = 400;
    for (const double angle : {0.0, 0.5, std::numbers::pi / 2}) {
        const std::vector<Contour> rings = nested_on_a_line(count, angle);
        EXPECT_NEAR(measure(united(rings)).area_mm2, 2.0 * count * count, 1e-3);
        EXPECT_EQ(united(rings).rings, 1U);
        const Layer odd = united(rings, FillRule::evenodd);
        EXPECT_NEAR(measure(odd).area_mm2, count * (count + 1.0), 1e-3); // every other ring is a hole
        EXPECT_FALSE(has_crossings(odd));
    }
}

/// Octagons within one another that touch at the origin.
std::vector<Contour> nested_at_a_point(int count) {
    std::vector<Contour> rings;
    for (int i = 1; i <= count; ++i) {
        const double radius = 50.0 * i / count;
        Contour& ring = rings.emplace_back(test::regular_polygon(8, radius));
        const double by = ring.front().x;
        for (Point2& p : ring)
            p.x -= by;
    }
    return rings;
}

// But for the rounding of coordinates: on the grid almost all of these sides cross one another.
TEST(Fill, AddsUpSidesThatNearlyLieOnOneLine) {
    for (const std::vector<Contour>& rings : {nested_at_a_point(1000), nested_on_a_line(1000, 0.3)}) {
        const std::size_t count = rings.size();
        std::vector<Contour> alternating = rings;
        double area = 0; // of every other ring without the one inside it
        for (std::size_t i = 0; i < count; ++i) {
            const double ring = measure(layer_of({rings[i]})).area_mm2;
            area += (count - i) % 2 == 1 ? ring : -ring;
            if ((count - i) % 2 == 0)
                std::reverse(alternating[i].begin(), alternating[i].end());
        }
        const double whole = measure(layer_of({rings.back()})).area_mm2;
        const Layer one = united(rings);
        EXPECT_EQ(one.rings, 1U);
        EXPECT_NEAR(measure(one).area_mm2, whole, 1e-9 * whole);
        const Layer odd = united(rings, FillRule::evenodd);
        EXPECT_NEAR(measure(odd).area_mm2, area, 1e-8 * whole);
        EXPECT_FALSE(has_crossings(odd));
        EXPECT_NEAR(measure(united(alternating)).area_mm2, area, 1e-8 * whole);
    }
}

TEST(Fill, OfThousandsOfRingsThatTouchInOnePointIsTheLargest) {
    const std::vector<Contour> rings = nested_at_a_point(4000);
    const Layer one = united(rings);
    EXPECT_EQ(one.rings, 1U);
    EXPECT_NEAR(measure(one).area_mm2, measure(layer_of({rings.back()})).area_mm2, 1e-6);
}

TEST(Fill, AddsUpNearlyCollinearSidesAmidOthersThatCrossThem) {
    Random random(47);
    for (int round = 0; round < 3; ++round) {
        const std::vector<Contour> nested = nested_on_a_line(1000, random.real(0.1, 1.4));
        std::vector<Contour> others;
        for (int i = 0; i < 200; ++i) {
            const double x = random.real(-900, 900);
            const double y = random.real(-900, 900);
            others.push_back(rectangle(x, y, x + random.real(1, 190), y + random.real(1, 190)));
        }
        std::vector<Contour> all = nested;
        all.insert(all.end(), others.begin(), others.end());
        const Layer material = united(all, FillRule::positive);
        EXPECT_FALSE(has_crossings(material));
        std::reverse(all.begin(), all.end());
        EXPECT_TRUE(same_contours(united(all, FillRule::positive), material));
        others.push_back(nested.back()); // the others of these lie within it
        const double area = measure(united(others, FillRule::positive)).area_mm2;
        EXPECT_NEAR(measure(material).area_mm2, area, 1e-9 * area);
    }
}

TEST(Fill, JoinsThousandsOfSidesThatMeetInOnePoint) {
    std::vector<Contour> apart;
    std::vector<Contour> overlapping;
    constexpr int count = 2000;
    const auto at = [](double share) {
        const double angle = 2 * std::numbers::pi * share / count;
        return Point2{100 * std::cos(angle), 100 * std::sin(angle)};
    };
    for (int i = 0; i < count; ++i) {
        apart.push_back({{0, 0}, at(i), at(i + 0.5)});
        overlapping.push_back({{0, 0}, at(i), at(i + 1.5)});
    }
    const Layer petals = normal_layer(apart);
    EXPECT_FALSE(fill(petals, FillRule::nonzero).changed());
    const Layer odd = united(overlapping, FillRule::evenodd);
    EXPECT_FALSE(has_crossings(odd));
    EXPECT_FALSE(fill(odd, FillRule::nonzero).changed());
    EXPECT_NEAR(measure(united(overlapping)).area_mm2, std::numbers::pi * 1e4, 1);
}

TEST(Fill, IsRefusedWhereItsCrossingsWouldTakeMoreMemoryThanThereIsForThem) {
    Random random(7);
    std::vector<Contour> chords;
    for (int i = 0; i < 2000; ++i)
        chords.push_back({{random.real(0, 100), random.real(0, 100)},
                          {random.real(0, 100), random.real(0, 100)},
                          {random.real(0, 100), random.real(0, 100)}});
    Layer layer = normal_layer(chords);
    layer.index = 12;
    test::expect_error(ErrorKind::limit, {"layer 12 at z = ", "crossings", "`max_memory`"},
                       [&] { static_cast<void>(fill(layer, FillRule::nonzero, {.memory = 1 << 19})); });
    CancelFlag stop;
    stop.request();
    test::expect_error(ErrorKind::cancelled, {},
                       [&] { static_cast<void>(fill(layer, FillRule::nonzero, {.cancel = &stop})); });
}

TEST(WindsOnce, IsTrueOfCleanPartsThatLieApart) {
    const Layer body =
        layer_of({rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 9, 9)), rectangle(2, 2, 3, 3)},
                 {{{0, 0}, {5, 5}, {20, 3}}});
    EXPECT_TRUE(winds_once({}));
    EXPECT_TRUE(winds_once({&body, 1}));
    const std::vector<Layer> apart{body, Layer{}, layer_of({rectangle(11, 0, 12, 5)}),
                                   layer_of({rectangle(0, 10.5, 20, 11)}), layer_of({}, {{{0, 0}, {9, 9}}})};
    EXPECT_TRUE(winds_once(apart));
}

TEST(WindsOnce, IsFalseOfWhatTouchesOverlapsOrIsTurned) {
    const Contour body = rectangle(0, 0, 10, 10);
    for (const Layer& layer :
         {layer_of({reversed(body)}), layer_of({body, body}), layer_of({body, rectangle(2, 2, 3, 3)}),
          layer_of({body, rectangle(10, 0, 20, 10)}), layer_of({body, rectangle(5, 5, 20, 20)}),
          layer_of({body, reversed(rectangle(1, 1, 9, 9)), reversed(rectangle(2, 2, 3, 3))}),
          layer_of({body, reversed(rectangle(20, 1, 29, 9))}), layer_of({{{0, 0}, {4, 4}, {4, 0}, {0, 4}}}),
          layer_of({body, {{20, 0}, {30, 0}}}), layer_of({{{20, 0}}, body})})
        EXPECT_FALSE(winds_once({&layer, 1}));
    const Layer one = layer_of({body});
    for (const Contour& other : {rectangle(10, 0, 20, 10), rectangle(3, 3, 4, 4), rectangle(-5, -5, 5, 50)}) {
        const std::vector<Layer> parts{layer_of({rectangle(50, 0, 51, 1)}), one, layer_of({other})};
        EXPECT_FALSE(winds_once(parts));
    }
}

TEST(WindsOnce, IsTrueOnlyWhereTheWindingNumberIsNoughtOrOne) {
    Random random(33);
    int clean = 0;
    for (int round = 0; round < 3000; ++round) {
        const bool integers = round % 2 == 0;
        const Layer layer = layer_of(random_rings(random, 100, integers ? 12 : 20, 3, integers));
        if (!winds_once({&layer, 1}))
            continue;
        ++clean;
        ASSERT_EQ(test::winding_area(layer, [](int winding) { return winding < 0 || winding > 1; }), 0)
            << "round " << round;
        ASSERT_FALSE(fill(layer, FillRule::nonzero).changed());
    }
    EXPECT_GT(clean, 300);
}

TEST(Fill, OfAnEmptyLayerIsEmpty) {
    EXPECT_EQ(fill(Layer{}, FillRule::nonzero).layer.contours(), 0U);
    EXPECT_EQ(fill(layer_of({{}, {{1, 1}}}), FillRule::nonzero).layer.contours(), 0U);
}

TEST(Fill, LeavesNoSliversThatAreTurnedOver) {
    Random random(23);
    for (int round = 0; round < 20'000; ++round) {
        // Far from the origin, turned bodies with sides on one another that rounding moves a little.
        const double angle = random.real(0, 2 * std::numbers::pi);
        const auto turned = [&](double x, double y) {
            return Point2{std::cos(angle) * x - std::sin(angle) * y,
                          std::sin(angle) * x + std::cos(angle) * y};
        };
        std::vector<Contour> rings;
        for (int i = 0; i < 3; ++i) {
            const auto x = static_cast<double>(random.integer(0, 3));
            const auto y = static_cast<double>(random.integer(0, 3));
            const auto w = static_cast<double>(random.integer(1, 3));
            const auto h = static_cast<double>(random.integer(1, 3));
            rings.push_back({turned(x, y), turned(x + w, y), turned(x + w, y + h), turned(x, y + h)});
        }
        for (const FillRule rule : {FillRule::nonzero, FillRule::evenodd, FillRule::positive}) {
            const Layer once = fill(normal_layer(rings), rule).layer;
            ASSERT_TRUE(same_contours(fill(once, rule).layer, once)) << round;
        }
    }
}

} // namespace
} // namespace lamella
