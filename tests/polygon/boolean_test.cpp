#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/fill.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "polygon/subtract.hpp"
#include "polygon/winding_areas.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>

namespace lamella::boolean_cases {
namespace {

using test::Contour;
using test::contours;
using test::diamond;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::reversed;

constexpr BooleanOperation unite = BooleanOperation::unite;
constexpr BooleanOperation intersect = BooleanOperation::intersect;
constexpr BooleanOperation subtract = BooleanOperation::subtract;
constexpr BooleanOperation exclude = BooleanOperation::exclude;
constexpr std::array<BooleanOperation, 4> operations{unite, intersect, subtract, exclude};

bool made(BooleanOperation operation, bool first, bool second) {
    switch (operation) {
    case intersect:
        return first && second;
    case subtract:
        return first && !second;
    case exclude:
        return first != second;
    default:
        return first || second;
    }
}

using Contours = std::vector<Contour>;

double area(const Layer& layer) {
    return measure(layer).area_mm2;
}

/// Rings of a few corners, some of them turned: on integers they touch and share edges, else they lie in
/// general position.
Contours random_rings(Random& random, double range, double size, std::int64_t most, bool integers) {
    Contours rings;
    for (std::int64_t c = random.integer(0, most); c > 0; --c) {
        const double x = random.real(0, range);
        const double y = random.real(0, range);
        Contour ring;
        for (std::int64_t i = random.integer(3, 8); i > 0; --i) {
            Point2 p{x + random.real(0, size), y + random.real(0, size)};
            if (integers)
                p = {std::round(p.x), std::round(p.y)};
            ring.push_back(p);
        }
        if (ring_area(ring) < 0 && random.integer(0, 5) != 0)
            ring = reversed(ring);
        rings.push_back(ring);
    }
    return rings;
}

Contours random_rings_on_a_grid(Random& random) {
    Contours rings;
    for (std::int64_t i = random.integer(1, 6); i > 0; --i) {
        Contour& ring = rings.emplace_back();
        for (std::int64_t k = random.integer(1, 9); k > 0; --k) {
            const auto x = static_cast<double>(random.integer(0, 16));
            ring.push_back({x, static_cast<double>(random.integer(0, 16))});
        }
    }
    return rings;
}

/// Two layers, which may have rings in common, the same way round or not.
struct Two {
    Two(Random& random, int round) {
        const bool integers = round % 2 == 0;
        const double range = integers ? 14 : 100;
        const double size = integers ? 8 : round % 3 == 0 ? 60 : 25;
        Contours a = random_rings(random, range, size, 6, integers);
        Contours b = random_rings(random, range, size, 6, integers);
        for (Contour ring : random_rings(random, range, size, 3, integers)) {
            a.push_back(ring);
            if (random.integer(0, 5) == 0)
                std::reverse(ring.begin(), ring.end());
            b.push_back(ring);
        }
        first = normal_layer(a);
        second = normal_layer(b);
    }

    Layer first;
    Layer second;
};

/// What rounding to the grid may make of areas.
double slack(const Layer& a, const Layer& b, double extent) {
    return 8 * (measure(a).perimeter_mm + measure(b).perimeter_mm) * extent * 0x1p-35 +
           1e-12 * extent * extent;
}

void expect_combined(const Layer& a, const Layer& b, BooleanOperation operation, double extent) {
    const Layer result = combine(a, b, operation);
    const double expected =
        test::winding_area(a, b, [&](int v, int w) { return made(operation, v > 0, w > 0); });
    const double tolerance = slack(a, b, extent);
    EXPECT_NEAR(area(result), expected, tolerance);
    EXPECT_TRUE(in_normal_form(result));
    EXPECT_EQ(find_crossings(result).count, 0U);
    EXPECT_NEAR(test::winding_area(result, [](int winding) { return winding > 1 || winding < 0; }), 0,
                tolerance);
    EXPECT_FALSE(fill(result, FillRule::positive).changed());
}

TEST(Combine, GivesTheAreaOfItsOperationForRandomLayers) {
    Random random(71);
    for (int round = 0; round < test::rounds_within_reason(2000); ++round) {
        const Two two(random, round);
        for (const BooleanOperation operation : operations) {
            expect_combined(two.first, two.second, operation, 200);
            if (testing::Test::HasFailure())
                FAIL() << "round " << round << " operation " << static_cast<int>(operation);
        }
    }
}

TEST(Combine, KeepsTheLawsOfSets) {
    Random random(72);
    for (int round = 0; round < test::rounds_within_reason(3000); ++round) {
        SCOPED_TRACE(round);
        const Two two(random, round);
        const Layer& a = two.first;
        const Layer& b = two.second;
        const double tolerance = 4 * slack(a, b, 200);
        const auto material = [](const Layer& layer) {
            return area(fill(layer, FillRule::positive).layer);
        };
        const Layer either = combine(a, b, unite);
        const Layer both = combine(a, b, intersect);
        const Layer one = combine(a, b, exclude);
        const Layer rest_of_a = combine(a, b, subtract);
        const Layer rest_of_b = combine(b, a, subtract);
        EXPECT_NEAR(area(either) + area(both), material(a) + material(b), tolerance);
        EXPECT_NEAR(area(rest_of_a) + area(both), material(a), tolerance);
        EXPECT_NEAR(area(combine(one, combine(rest_of_a, rest_of_b, unite), exclude)), 0, tolerance);
        EXPECT_NEAR(area(combine(combine(either, both, subtract), one, exclude)), 0, tolerance);
        // The order of the operands does not matter, nor does that of their contours.
        EXPECT_TRUE(same_contours(either, combine(b, a, unite)));
        EXPECT_TRUE(same_contours(both, combine(b, a, intersect)));
        EXPECT_TRUE(same_contours(one, combine(b, a, exclude)));
        Contours turned = contours(a);
        std::reverse(turned.begin(), turned.end());
        for (Contour& ring : turned)
            std::rotate(ring.begin(), ring.begin() + 1, ring.end());
        EXPECT_TRUE(same_contours(one, combine(layer_of(turned), b, exclude)));
        if (testing::Test::HasFailure())
            return;
    }
}

// What was made of layers has corners a little beside the sides on which they were, and sides that all but
// lie upon one another. Rounding, cut by cut, once drew such sides from place to place of the grid until
// parts turned over.
TEST(Combine, TakesWhatItMadeItself) {
    for (const std::uint64_t seed : {2, 6, 7}) {
        Random random(seed);
        for (int round = 0; round < test::rounds_within_reason(150); ++round) {
            SCOPED_TRACE(round);
            std::array<Layer, 5> layers;
            for (Layer& layer : layers)
                layer = fill(layer_of(random_rings_on_a_grid(random)), FillRule::nonzero).layer;
            const Layer& middle = layers[2];
            const Layer above = combine(middle, combine(layers[3], layers[4], intersect), subtract);
            const Layer below = combine(middle, combine(layers[1], layers[0], intersect), subtract);
            expect_combined(above, below, subtract, 16);
            const Layer rest = combine(middle, below, subtract);
            expect_combined(middle, below, subtract, 16);
            expect_combined(rest, above, subtract, 16);
            if (testing::Test::HasFailure())
                return;
        }
    }
}

TEST(Combine, OfALayerWithItselfIsItselfOrNothingBitForBit) {
    Random random(73);
    for (int round = 0; round < test::rounds_within_reason(1000); ++round) {
        SCOPED_TRACE(round);
        const Layer given = Two(random, round).first;
        const Layer layer = fill(given, FillRule::positive).layer;
        EXPECT_TRUE(same_contours(combine(layer, layer, unite), layer));
        EXPECT_TRUE(same_contours(combine(layer, layer, intersect), layer));
        EXPECT_TRUE(same_contours(combine(given, given, intersect), layer));
        EXPECT_EQ(combine(given, given, subtract).contours(), 0U);
        EXPECT_EQ(combine(given, given, exclude).contours(), 0U);
        const Layer nothing;
        EXPECT_TRUE(same_contours(combine(layer, nothing, unite), layer));
        EXPECT_TRUE(same_contours(combine(nothing, layer, unite), layer));
        EXPECT_TRUE(same_contours(combine(layer, nothing, subtract), layer));
        EXPECT_TRUE(same_contours(combine(layer, nothing, exclude), layer));
        EXPECT_EQ(combine(layer, nothing, intersect).contours(), 0U);
        EXPECT_EQ(combine(nothing, layer, subtract).contours(), 0U);
    }
}

TEST(Combine, KeepsDropsAndTurnsRingsThatMeetNothing) {
    const Contour frame{{0, 0}, {9.1, 0.3}, {9, 9}, {0.2, 9}};
    const Contour inner = diamond(4, 4, 0.3);
    const Contour apart = diamond(20, 4, 0.7);
    const Layer a = normal_layer({frame});
    const Layer b = normal_layer({inner, apart});
    EXPECT_EQ(contours(combine(a, b, unite)), contours(normal_layer({frame, apart})));
    EXPECT_EQ(contours(combine(a, b, intersect)), contours(normal_layer({inner})));
    EXPECT_EQ(contours(combine(a, b, subtract)), contours(normal_layer({frame, reversed(inner)})));
    EXPECT_EQ(contours(combine(b, a, subtract)), contours(normal_layer({apart})));
    EXPECT_EQ(contours(combine(a, b, exclude)), contours(normal_layer({frame, reversed(inner), apart})));
    // A body in a hole, and a hole that both have.
    const Layer ring = normal_layer({frame, reversed(inner)});
    EXPECT_EQ(contours(combine(ring, b, unite)), contours(normal_layer({frame, apart})));
    EXPECT_EQ(contours(combine(ring, b, intersect)), Contours{});
    EXPECT_EQ(contours(combine(ring, normal_layer({rectangle(-1, -1, 10, 10)}), intersect)), contours(ring));
}

TEST(Combine, KeepsRingsThatOnlyTouchBitForBit) {
    const Contour square = rectangle(0, 0, 2, 2);
    const Layer a = normal_layer({square});
    for (const Contour& other : {rectangle(2, 2, 4, 4), diamond(3, 1, 1)}) {
        const Layer b = normal_layer({other});
        const Contours both = contours(normal_layer({square, other}));
        EXPECT_EQ(contours(combine(a, b, unite)), both);
        EXPECT_EQ(contours(combine(a, b, exclude)), both);
        EXPECT_EQ(contours(combine(a, b, subtract)), contours(a));
        EXPECT_EQ(contours(combine(b, a, subtract)), contours(b));
        EXPECT_EQ(contours(combine(a, b, intersect)), Contours{});
    }
}

TEST(Combine, LeavesNoWallsBetweenLayersThatShareEdges) {
    const Layer left = normal_layer({rectangle(0, 0, 2, 2)});
    const Layer right = normal_layer({rectangle(2, 0, 4, 2)});
    const Layer whole = combine(left, right, unite);
    EXPECT_EQ(whole.rings, 1U);
    EXPECT_EQ(area(whole), 8);
    EXPECT_EQ(combine(left, right, exclude).rings, 1U);
    EXPECT_EQ(combine(left, right, intersect).rings, 0U);
    EXPECT_EQ(area(combine(left, right, subtract)), 4);
    EXPECT_EQ(area(combine(whole, right, subtract)), 4);
    // What fills a hole.
    const Contour hole = diamond(5, 5, 3);
    const Layer pierced = normal_layer({rectangle(0, 0, 10, 10), reversed(hole)});
    EXPECT_EQ(contours(combine(pierced, normal_layer({hole}), unite)), Contours{rectangle(0, 0, 10, 10)});
    EXPECT_EQ(contours(combine(normal_layer({rectangle(0, 0, 10, 10)}), pierced, subtract)), Contours{hole});
}

TEST(Combine, CutsBodiesThatCross) {
    const Layer a = normal_layer({rectangle(0, 0, 4, 4)});
    const Layer b = normal_layer({rectangle(2, 2, 6, 6)});
    EXPECT_EQ(contours(combine(a, b, unite)),
              (Contours{{{0, 0}, {4, 0}, {4, 2}, {6, 2}, {6, 6}, {2, 6}, {2, 4}, {0, 4}}}));
    EXPECT_EQ(contours(combine(a, b, intersect)), (Contours{rectangle(2, 2, 4, 4)}));
    EXPECT_EQ(contours(combine(a, b, subtract)),
              (Contours{{{0, 0}, {4, 0}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}}));
    EXPECT_EQ(area(combine(a, b, exclude)), 24);
}

TEST(Combine, CountsOverlapsOnceAndBodiesTurnedInsideOutNot) {
    const Contour square = rectangle(0, 0, 4, 4);
    const Layer twice = normal_layer({square, rectangle(1, 1, 3, 3), square});
    const Layer other = normal_layer({rectangle(2, -1, 6, 5)});
    EXPECT_EQ(area(combine(twice, other, intersect)), 8);
    EXPECT_EQ(area(combine(twice, other, subtract)), 8);
    EXPECT_EQ(combine(normal_layer({reversed(square)}), other, intersect).rings, 0U);
    EXPECT_EQ(area(combine(other, normal_layer({reversed(square)}), subtract)), 24);
    // A ring that both have, once more in one of them.
    EXPECT_EQ(combine(twice, normal_layer({square}), exclude).rings, 0U);
}

TEST(Combine, TakesHeaderAndChainsOfTheFirstLayer) {
    Layer a = normal_layer({rectangle(0, 0, 4, 4)}, {{{0, 9}, {5, 9}}});
    a.index = 7;
    a.z = 1.5;
    a.bottom = 1;
    a.top = 2;
    const Layer b = normal_layer({rectangle(2, 0, 6, 4)}, {{{0, 8}, {5, 8}}});
    for (const Layer& other : {a, b})
        for (const BooleanOperation operation : operations) {
            const Layer result = combine(a, other, operation);
            EXPECT_EQ(result.index, 7U);
            EXPECT_EQ(result.z, 1.5);
            EXPECT_EQ(result.bottom, 1);
            EXPECT_EQ(result.top, 2);
            ASSERT_EQ(result.open_chains(), 1U);
            EXPECT_EQ(contours(result).back(), (Contour{{0, 9}, {5, 9}}));
        }
}

Layer turned_layer(const Contours& rings, double radians, const Point2& to) {
    Contours turned;
    for (const Contour& ring : rings) {
        Contour& out = turned.emplace_back();
        for (const Point2& p : ring)
            out.push_back({std::cos(radians) * p.x - std::sin(radians) * p.y + to.x,
                           std::sin(radians) * p.x + std::cos(radians) * p.y + to.y});
    }
    return normal_layer(turned);
}

TEST(SubtractBody, LeavesNotchesAndNoFilmsWhereItIsFlushWithWalls) {
    struct Case {
        Contour body;
        std::size_t rings;
        double area;
    };
    const Contour part = rectangle(0, 0, 20, 20);
    const std::array cases{
        Case{rectangle(8, 0, 12, 3), 1, 388},                // in the middle of a wall
        Case{rectangle(0, 0, 3, 4), 1, 388},                 // in a corner
        Case{rectangle(0, 0, 20, 5), 1, 300},                // along a whole wall
        Case{rectangle(7, 0, 9, 20), 2, 360},                // from wall to wall
        Case{rectangle(0, 0, 20, 20), 0, 0},                 // all of it
        Case{rectangle(8, 2, 12, 5), 2, 388},                // inside
        Case{rectangle(8, 1e-3, 12, 3), 2, 400 - 4 * 2.999}, // inside, near a wall
    };
    std::size_t films = 0; // that exact subtraction leaves
    for (int i = 0; i < 400; ++i) {
        const double angle = 0.0157 * i;
        const Point2 to{i % 3 == 0 ? 0 : 137.3 * i, i % 2 == 0 ? 0 : -11.7};
        const Layer layer = turned_layer({part}, angle, to);
        for (const Case& one : cases) {
            const Layer body = turned_layer({one.body}, angle, to);
            const Layer result = subtract_body(layer, body);
            ASSERT_EQ(result.rings, one.rings) << "turn " << i << ", area " << one.area;
            ASSERT_NEAR(area(result), one.area, 1e-6);
            ASSERT_FALSE(has_crossings(result));
            films += combine(layer, body, subtract).rings != one.rings ? 1 : 0;
        }
    }
    EXPECT_GT(films, 50U);
}

TEST(SubtractBody, GivesTheAreaOfTheDifferenceForRandomLayers) {
    Random random(43);
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        const bool integers = round % 2 == 0;
        const double turn = round % 3 == 0 ? 0.7 : 0;
        const Layer layer = turned_layer(random_rings(random, 8, 6, 8, integers), turn, {});
        const Layer body = turned_layer(random_rings(random, 8, 6, 8, integers), turn, {});
        const Layer found = subtract_body(layer, body);
        EXPECT_NEAR(area(found), area(combine(layer, body, subtract)), 1e-6) << round;
        EXPECT_LT(area(combine(found, combine(layer, body, subtract), exclude)), 1e-6) << round;
        EXPECT_FALSE(has_crossings(found)) << round;
    }
}

TEST(SubtractBody, LeavesBodiesApartThatOnlyTouchOneAnother) {
    const Layer layer =
        turned_layer({rectangle(0, 0, 5, 9), rectangle(5, 0, 9, 9), rectangle(20, 0, 29, 9)}, 0.3, {});
    const Layer body = turned_layer({rectangle(22, 0, 25, 2)}, 0.3, {});
    EXPECT_EQ(subtract_body(layer, body).rings, 3U);
}

TEST(SubtractCommon, LeavesWhatSomeOfTheOthersHaveNot) {
    Random random(41);
    double left = 0;
    for (int round = 0; round < test::rounds_within_reason(400); ++round) {
        const bool integers = round % 2 == 0;
        const Layer layer = normal_layer(random_rings(random, 8, 6, 6, integers));
        std::vector<Layer> others;
        Layer expected;
        for (std::int64_t k = random.integer(1, 4); k > 0; --k) {
            const Layer other = normal_layer(random_rings(random, 8, 8, 6, integers));
            others.push_back(fill(random.integer(0, 5) == 0 ? layer : other, FillRule::positive).layer);
            expected = combine(expected, combine(layer, others.back(), subtract), unite);
        }
        const Layer found = subtract_common(layer, others);
        EXPECT_LT(area(combine(found, expected, exclude)), 1e-6) << round;
        EXPECT_FALSE(has_crossings(found)) << round;
        left += area(found);
    }
    EXPECT_GT(left, 0);
}

TEST(Combine, OfDegenerateLayersHasNoMaterial) {
    const Layer flat = layer_of({{}, {{1, 1}}, {{0, 0}, {3, 3}, {1, 1}}, {{2, 0}, {2, 5}}});
    const Layer body = normal_layer({rectangle(0, 0, 4, 4)});
    for (const BooleanOperation operation : operations) {
        EXPECT_EQ(combine(flat, flat, operation).contours(), 0U);
        EXPECT_EQ(combine(flat, Layer{}, operation).contours(), 0U);
        EXPECT_EQ(combine(Layer{}, flat, operation).contours(), 0U);
        EXPECT_EQ(combine(Layer{}, Layer{}, operation).contours(), 0U);
    }
    EXPECT_EQ(contours(combine(body, flat, subtract)), contours(body));
    EXPECT_EQ(contours(combine(flat, body, unite)), contours(body));
    EXPECT_EQ(combine(body, flat, intersect).contours(), 0U);
}

TEST(Combine, DoesNotDependOnPlaceAndScaleBeyondRounding) {
    Random random(74);
    const Contours a = random_rings(random, 100, 40, 30, false);
    const Contours b = random_rings(random, 100, 40, 30, false);
    for (const BooleanOperation operation : operations) {
        const double expected = area(combine(normal_layer(a), normal_layer(b), operation));
        for (const double scale : {0x1p-400, 1e-6, 1e6, 0x1p400})
            for (const double shift : {0.0, 1000.0}) {
                const auto moved = [&](Contours rings) {
                    for (Contour& ring : rings)
                        for (Point2& p : ring)
                            p = {(p.x + shift) * scale, (p.y - shift) * scale};
                    return normal_layer(rings);
                };
                EXPECT_NEAR(area(combine(moved(a), moved(b), operation)) / scale / scale, expected,
                            1e-6 * expected + 1e-6)
                    << scale << ' ' << shift;
            }
    }
}

TEST(Combine, KeepsWhatIsFarFromOtherRingsBitForBit) {
    // Many rings of both layers, few of one: the others pass a union, and cancel in a difference.
    Random random(75);
    Contours common;
    for (int i = 0; i < 20; ++i)
        for (int j = 0; j < 20; ++j)
            common.push_back(
                diamond(i + random.real(0, 0.2), j + random.real(0, 0.2), random.real(0.1, 0.3)));
    Contours more = common;
    const Contour extra = diamond(7.5, 7.5, 0.9);
    more.push_back(extra);
    const Layer a = normal_layer(more);
    const Layer b = normal_layer(common);
    const Contours united = contours(combine(a, b, unite));
    const std::set<Contour> found(united.begin(), united.end());
    std::size_t kept = 0;
    for (const Contour& ring : common)
        kept += found.contains(ring) ? 1 : 0;
    EXPECT_GT(kept, 380U);
    const Layer rest = combine(a, b, subtract);
    EXPECT_NEAR(area(rest), area(combine(normal_layer({extra}), b, subtract)), 1e-9);
    EXPECT_TRUE(same_contours(rest, combine(a, b, exclude)));
    EXPECT_EQ(combine(b, a, subtract).contours(), 0U);
}

} // namespace
} // namespace lamella::boolean_cases
