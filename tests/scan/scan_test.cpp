#include "lamella/contour/exposure.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/offset.hpp"
#include "lamella/scan/scan.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/rounds.hpp"
#include "scan/random_layers.hpp"
#include "scan/skin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>
#include <span>
#include <vector>

namespace lamella::scan_cases {
namespace {

using test::Contour;
using test::contours;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::random_material;
using test::rectangle;
using test::reversed;
using test::rounds_within_reason;

double distance_to(const Layer& outline, const Point2& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t r = 0; r < outline.rings; ++r)
        for (std::size_t i = 0; i < outline.contour(r).size(); ++i) {
            const Point2& a = outline.contour(r)[i];
            const Point2& b = outline.contour(r)[(i + 1) % outline.contour(r).size()];
            const Point2 way{b.x - a.x, b.y - a.y};
            const double square = way.x * way.x + way.y * way.y;
            const double along = square == 0 ? 0 : ((p.x - a.x) * way.x + (p.y - a.y) * way.y) / square;
            const double t = std::clamp(along, 0.0, 1.0);
            least = std::min(least, std::hypot(a.x + t * way.x - p.x, a.y + t * way.y - p.y));
        }
    return least;
}

double marked(const Plane& vectors, std::size_t exposure) {
    return measure_vectors(vectors.polylines[exposure], vectors.hatches[exposure].span(), {})
        .figures.marked_mm;
}

Plane vectors_of(const ScanLayer& layer, const ScanStrategy& strategy = {}, InsetCache* cache = nullptr) {
    return scan(layer, {}, {}, strategy, {.cache = cache}).vectors;
}

bool same_hatches(const PointArray& a, const PointArray& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
}

TEST(Scan, CountsTheVectorsOfAllRegionsBeforeItTakesMemory) {
    ScanStrategy strategy;
    strategy.downskin.layers = strategy.upskin.layers = 1;
    Layer square = normal_layer({rectangle(0, 0, 50, 50)});
    square.index = 7;
    const ScanLayer layer(square);
    const std::vector<ScanLayer> beside{normal_layer({rectangle(0, 0, 50, 25)})};
    std::uint64_t points = 0;
    const Plane all = scan(layer, beside, beside, strategy).vectors;
    for (std::size_t i = 0; i < all.parts(); ++i)
        points += all.polylines[i].points.size() + all.hatches[i].size();
    const auto with = [&](const LayerLimits& limits) {
        static_cast<void>(scan(layer, beside, beside, strategy, {.limits = limits}));
        static_cast<void>(scan_support(layer, strategy, {.limits = limits}));
    };
    EXPECT_NO_THROW(with({.memory = 300 * points}));
    test::expect_error(ErrorKind::limit, {"layer 7 at z = ", "`max_memory`"},
                       [&] { with({.memory = 30 * points}); });
    CancelFlag stop;
    stop.request();
    test::expect_error(ErrorKind::cancelled, {}, [&] { with({.cancel = &stop}); });
    test::expect_error(ErrorKind::cancelled, {},
                       [&] { static_cast<void>(ScanLayer(square, {}, {.cancel = &stop})); });
}

TEST(Scan, GivesALayerForEachExposureWithTheHeightsOfItsOwn) {
    ScanStrategy strategy;
    strategy.contours.count = 3;
    Layer layer = normal_layer({rectangle(0, 0, 10, 10)});
    layer.index = 7;
    layer.z = 0.225;
    layer.bottom = 0.21;
    layer.top = 0.24;
    const Plane vectors = vectors_of(layer, strategy);
    const std::vector<Exposure> expected = exposures(strategy, "part");
    ASSERT_EQ(vectors.parts(), expected.size());
    for (std::size_t i = 0; i < vectors.parts(); ++i) {
        EXPECT_EQ(vectors.polylines[i].index, 7U);
        EXPECT_EQ(vectors.polylines[i].z, 0.225);
        EXPECT_EQ(vectors.polylines[i].bottom, 0.21);
        EXPECT_EQ(vectors.polylines[i].top, 0.24);
        const bool is_hatch = expected[i].kind == VectorKind::hatch;
        EXPECT_EQ(vectors.hatches[i].empty(), !is_hatch);
        EXPECT_EQ(vectors.polylines[i].rings, is_hatch ? 0U : 1U);
    }
    EXPECT_NEAR(measure(vectors.polylines[1]).perimeter_mm, 4 * (10 - 2 * 0.25), 1e-12); // the innermost
    EXPECT_NEAR(measure(vectors.polylines[3]).perimeter_mm, 4 * (10 - 2 * 0.05), 1e-12);
}

double sum(const std::vector<double>& areas) {
    return std::accumulate(areas.begin(), areas.end(), 0.0);
}

double unreached(const Layer& layer, const ScanStrategy& strategy) {
    return sum(scan(layer, {}, {}, strategy).unreached_mm2);
}

TEST(Scan, MeasuresWhatNoVectorReaches) {
    const Layer layer = normal_layer({rectangle(0, 0, 10, 10), rectangle(12, 0, 12.09, 10)});
    ScanStrategy strategy; // the outermost contour is at 0.05
    strategy.contours.thin_walls = ThinWalls::leave_out;
    InsetCache memory;
    std::vector<double> areas = scan(layer, {}, {}, strategy).unreached_mm2;
    ASSERT_EQ(areas.size(), 2U);
    EXPECT_EQ(areas[0], 0) << "the hatch";
    EXPECT_NEAR(areas[1], 0.9, 1e-9) << "the contour";
    static_cast<void>(vectors_of(layer, strategy, &memory));
    areas = scan(layer, {}, {}, strategy, {.cache = &memory}).unreached_mm2;
    EXPECT_NEAR(areas[1], 0.9, 1e-9) << "out of the memory, too";
    strategy.contours.beam_offset = 0.04;
    areas = scan(layer, {}, {}, strategy, {.cache = &memory}).unreached_mm2;
    EXPECT_EQ(sum(areas), 0);
    strategy.contours.count = 0; // the border of the hatch is at 0.05
    areas = scan(layer, {}, {}, strategy, {.cache = &memory}).unreached_mm2;
    EXPECT_NEAR(sum(areas), 0.9, 1e-3); // and the corners of the square, which hatch lines round off
    strategy.support.contours.thin_walls = ThinWalls::leave_out;
    areas = scan_support(layer, strategy).unreached_mm2;
    EXPECT_NEAR(sum(areas), 0.9, 1e-9);
}

TEST(Scan, ReachesAllOfWhatIsWide) {
    for (const HatchPattern pattern : {HatchPattern::lines, HatchPattern::meander, HatchPattern::stripes,
                                       HatchPattern::chessboard, HatchPattern::hexagons}) {
        ScanStrategy strategy;
        strategy.hatch.pattern = pattern;
        for (const double overlap : {0.0, 0.1})
            for (std::uint64_t index = 0; index < 5; ++index) {
                strategy.hatch.overlap = overlap;
                Layer layer =
                    normal_layer({test::regular_polygon(200, 7), reversed(rectangle(-1, -1, 1, 1))});
                layer.index = index;
                EXPECT_EQ(unreached(layer, strategy), 0) << hatch_pattern_name(pattern);
            }
    }
}

/// A wall with its middle at (3, -2).
Layer wall_at(double degrees, double length, double thick, std::uint64_t index) {
    const double angle = degrees * std::numbers::pi / 180;
    Contour ring = rectangle(-length / 2, -thick / 2, length / 2, thick / 2);
    for (Point2& p : ring)
        p = {p.x * std::cos(angle) - p.y * std::sin(angle) + 3,
             p.x * std::sin(angle) + p.y * std::cos(angle) - 2};
    Layer wall = normal_layer({ring});
    wall.index = index;
    return wall;
}

// Between its contours 0.05 mm are left: some lines are too short there, and some directions have none.
TEST(Scan, MeasuresWhatIsLeftInTheMiddleOfAWallWhereLinesDoNotFit) {
    ScanStrategy strategy;
    strategy.contours.thin_walls = ThinWalls::leave_out;
    double least = 9;
    double most = 0;
    for (std::uint64_t index = 0; index < 12; ++index) {
        const Layer wall = wall_at(0, 10, 0.25, index);
        const double area = unreached(wall, strategy);
        least = std::min(least, area);
        most = std::max(most, area);
        if (vectors_of(wall, strategy).hatches[0].empty()) {
            EXPECT_NEAR(area, 0.05 * 9.8, 1e-4);
        }
    }
    EXPECT_LT(least, 0.01);
    EXPECT_NEAR(most, 0.05 * 9.8, 1e-4);
}

// Whatever the direction of the hatch in a layer: where it has no lines, one runs along the middle.
TEST(Scan, LeavesNothingBareInWallsOfAnyThickness) {
    constexpr double length = 10;
    for (const std::uint32_t contours : {1U, 2U, 3U})
        for (const HatchPattern pattern : {HatchPattern::stripes, HatchPattern::chessboard}) {
            ScanStrategy strategy;
            strategy.contours.count = contours;
            strategy.hatch.pattern = pattern;
            for (double thick = 0.2; thick < 0.2 * contours + 0.21; thick += 0.015)
                for (const double degrees : {0.0, 17.0, 45.0, 90.0, 151.0}) {
                    std::size_t with_lines = 0;
                    for (std::uint64_t index = 0; index < 12; ++index) {
                        const Layer wall = wall_at(degrees, length, thick, index);
                        EXPECT_LT(unreached(wall, strategy), strategy.accepted_mm2)
                            << contours << " contours, " << thick << " mm, turned by " << degrees
                            << ", layer " << index;
                        const Plane vectors = vectors_of(wall, strategy);
                        double lines = 0;
                        for (std::size_t i = 0; i < vectors.parts(); ++i)
                            lines += marked(vectors, i);
                        with_lines += lines > 2 * length ? 1 : 0;
                    }
                    if (thick > 0.21 && contours == 1) {
                        EXPECT_EQ(with_lines, 12U) << thick << " mm, turned by " << degrees;
                    }
                }
        }
}

// Lines along the middle have the parameters of contours, and there are none.
TEST(Scan, CountsWhatAHatchWithoutContoursLeavesBare) {
    ScanStrategy strategy;
    strategy.contours.count = 0; // the border of the hatch leaves 0.05 mm of the wall
    std::size_t bare_layers = 0;
    for (std::uint64_t index = 0; index < 12; ++index) {
        const Layer wall = wall_at(0, 10, 0.15, index);
        const Plane vectors = vectors_of(wall, strategy);
        ASSERT_EQ(vectors.parts(), 1U);
        const bool bare = vectors.hatches[0].empty();
        bare_layers += bare ? 1 : 0;
        if (bare) {
            EXPECT_NEAR(unreached(wall, strategy), 0.15 * 10, 1e-9) << index;
        }
    }
    EXPECT_GT(bare_layers, 0U);
}

TEST(Scan, GivesALineOnlyToWallsThatItsHatchLeavesBare) {
    ScanStrategy strategy;
    Layer layer = normal_layer({rectangle(0, 0, 10, 10), rectangle(20, 0, 30, 0.25)});
    for (layer.index = 0; layer.index < 12; ++layer.index) {
        strategy.contours.thin_walls = ThinWalls::leave_out;
        const bool bare = unreached(layer, strategy) > strategy.accepted_mm2;
        const Plane before = vectors_of(layer, strategy);
        strategy.contours.thin_walls = ThinWalls::line;
        const Plane vectors = vectors_of(layer, strategy);
        EXPECT_TRUE(same_hatches(vectors.hatches[0], before.hatches[0])) << "the hatch stays as it is";
        ASSERT_LE(vectors.hatches[1].size(), 2U) << layer.index;
        if (bare) {
            ASSERT_EQ(vectors.hatches[1].size(), 2U) << layer.index;
        }
        for (const Point2& end : vectors.hatches[1])
            EXPECT_NEAR(end.y, 0.125, 1e-6);
        EXPECT_LT(unreached(layer, strategy), strategy.accepted_mm2);
    }
    strategy.contours.count = 2; // no second contour fits: there is a line instead, whatever the hatch
    const Layer wall = wall_at(0, 10, 0.25, 0);
    EXPECT_EQ(vectors_of(wall, strategy).polylines[1].rings, 0U);
    EXPECT_EQ(vectors_of(wall, strategy).hatches[1].size(), 2U);
    EXPECT_LT(unreached(wall, strategy), 1e-3);
}

TEST(Scan, DistinguishesOfWhichRegionItIsThatNothingReaches) {
    ScanStrategy strategy;
    strategy.contours.thin_walls = ThinWalls::leave_out;
    strategy.hatch.angle_degrees = 45;
    strategy.upskin = strategy.downskin;
    strategy.upskin.layers = 1;
    strategy.upskin.hatch.angle_degrees = 45;
    strategy.hatch.shortest = strategy.upskin.hatch.shortest = 0.2;
    const Layer walls = normal_layer({rectangle(0, 0, 10, 0.25), rectangle(0, 5, 20, 5.25)});
    const std::vector<ScanLayer> above{normal_layer({rectangle(0, 0, 10, 0.25)})};
    const std::vector<double> areas = scan(walls, {}, above, strategy).unreached_mm2;
    ASSERT_EQ(areas.size(), 3U); // core hatch, upskin hatch, contour
    EXPECT_NEAR(areas[0], 0.05 * 9.8, 1e-3);
    EXPECT_NEAR(areas[1], 0.05 * 19.8, 1e-3);
    EXPECT_EQ(areas[2], 0);
}

TEST(Scan, GivesThinWallsALineThatEveryOrderOfRingsHas) {
    const std::vector<Contour> rings{rectangle(0, 0, 10, 10), rectangle(12, 0, 12.09, 10),
                                     rectangle(13, 3, 19, 3.07), reversed(rectangle(2, 2, 3, 3))};
    const ScanStrategy strategy;
    const Plane vectors = vectors_of(normal_layer(rings), strategy);
    ASSERT_EQ(vectors.hatches[1].size(), 4U);
    EXPECT_EQ(vectors.polylines[1].rings, 2U);
    EXPECT_NEAR(marked(vectors, 1), 4 * 9.9 + 4 * 1.1 + 10 + 6, 0.15);
    EXPECT_LT(unreached(normal_layer(rings), strategy), 2e-3);
    const Plane again = vectors_of(layer_of({rings[2], rings[3], rings[1], rings[0]}), strategy);
    EXPECT_TRUE(same_hatches(again.hatches[1], vectors.hatches[1]));
}

TEST(Scan, KeepsItsDistancesToTheOutline) {
    Random random(5);
    ScanStrategy strategy;
    strategy.contours.count = 2;
    strategy.contours.beam_offset = 0.3;
    strategy.contours.distance = 0.2;
    strategy.hatch.border = 0.25;
    strategy.hatch.shortest = 0;
    for (int round = 0; round < rounds_within_reason(300); ++round) {
        const Layer layer = test::random_material(random, 16);
        const Plane vectors = vectors_of(layer, strategy);
        const double slack = 1e-6;
        for (const Point2& p : vectors.hatches[0])
            EXPECT_GE(distance_to(layer, p), 0.75 - slack) << round;
        for (const Point2& p : vectors.polylines[1].points)
            EXPECT_GE(distance_to(layer, p), 0.5 - slack) << round;
        for (const Point2& p : vectors.polylines[2].points)
            EXPECT_GE(distance_to(layer, p), 0.3 - slack) << round;
    }
}

TEST(Scan, HatchesTheOutlineItselfWhereNothingLiesBetween) {
    ScanStrategy strategy;
    strategy.contours.count = 0;
    strategy.hatch.border = 0;
    strategy.hatch.pattern = HatchPattern::lines;
    strategy.hatch.distance = 1;
    // Bodies that overlap count once.
    const Layer layer = normal_layer({rectangle(0, 0, 6, 4), rectangle(3, 0, 9, 4)});
    EXPECT_NEAR(marked(vectors_of(layer, strategy), 0), 4 * 9, 1e-6);
}

/// A pin in its bore, with the same points on either side, rounded to thousandths.
Layer pin_in_bore() {
    Contour pin;
    for (const Point2& p : test::regular_polygon(256, 2))
        pin.push_back({std::round(p.x * 1000) / 1000 + 0.0, std::round(p.y * 1000) / 1000 + 0.0});
    return normal_layer({rectangle(-5, -5, 5, 5), reversed(pin), pin});
}

// Of the bore other points are straight than of the pin, which begins elsewhere.
TEST(Scan, UnitesBodiesThatFitInOneAnotherWhateverPointsAreStraight) {
    ScanStrategy strategy;
    strategy.contours.count = 1;
    EXPECT_EQ(vectors_of({pin_in_bore(), {.step_mm = 0.001}}, strategy).polylines.back().rings, 1U);
    EXPECT_EQ(offset(pin_in_bore(), -0.05).rings, 1U);
}

TEST(Scan, FindsSkinsUnderBodiesThatOverlapAlsoWhereNoneIsTooNarrow) {
    ScanStrategy strategy;
    strategy.downskin.layers = 2;
    const auto at = [](Layer layer, double bottom) {
        layer.bottom = bottom;
        layer.top = bottom + 1;
        return layer;
    };
    const Layer layer = at(normal_layer({rectangle(0, 0, 10, 10)}), 2);
    const std::vector<ScanLayer> below{
        at(normal_layer({rectangle(-1, -1, 11, 11), rectangle(-2, -2, 12, 12)}), 1),
        at(normal_layer({rectangle(100, 100, 110, 110)}), 0)};
    std::vector<double> lengths;
    for (const double narrowest : {0.1, 0.0}) {
        strategy.downskin.narrowest = narrowest;
        const std::vector<Exposure> kinds = exposures(strategy, {});
        const Plane vectors = scan(layer, below, {}, strategy).vectors;
        double length = 0;
        for (std::size_t i = 0; i < kinds.size(); ++i)
            if (kinds[i].region == ScanRegion::downskin)
                length += marked(vectors, i);
        lengths.push_back(length);
    }
    EXPECT_GT(lengths[0], 100);
    EXPECT_NEAR(lengths[0], lengths[1], 1);
}

TEST(Scan, PutsRingsInTheirOrderWhereNothingMovesThem) {
    ScanStrategy strategy;
    strategy.contours.beam_offset = 0;
    strategy.contours.start = StartPoint::random;
    std::vector<Contour> rings;
    for (int i = 0; i < 6; ++i)
        rings.push_back(rectangle(20 * i, 0, 20 * i + 10, 10));
    const Plane expected = vectors_of(layer_of(rings), strategy);
    std::reverse(rings.begin(), rings.end());
    const Plane found = vectors_of(layer_of(rings), strategy);
    for (std::size_t i = 0; i < expected.parts(); ++i)
        EXPECT_TRUE(same_contours(found.polylines[i], expected.polylines[i])) << i;
}

TEST(Scan, KnowsNoWallsBetweenBodiesThatTouch) {
    ScanStrategy strategy;
    strategy.contours.beam_offset = 0;
    strategy.hatch.border = 0;
    const Layer two = normal_layer({rectangle(0, 0, 2.05, 4), rectangle(2.05, 0, 4, 4)});
    const Layer one = normal_layer({rectangle(0, 0, 4, 4)});
    for (const HatchPattern pattern : {HatchPattern::lines, HatchPattern::stripes}) {
        strategy.hatch.pattern = pattern;
        const Plane found = vectors_of(two, strategy);
        const Plane expected = vectors_of(one, strategy);
        ASSERT_EQ(found.parts(), expected.parts());
        for (std::size_t i = 0; i < found.parts(); ++i) {
            EXPECT_EQ(found.polylines[i].rings, expected.polylines[i].rings);
            EXPECT_EQ(found.hatches[i].size(), expected.hatches[i].size());
            EXPECT_NEAR(marked(found, i), marked(expected, i), 1e-6);
        }
    }
}

// A stack of random layers: with the same lines in all regions, all together cover what the layer has, and
// each what it should.
TEST(Scan, RegionsAreDisjointAndMakeUpTheLayer) {
    Random random(6);
    ScanStrategy strategy;
    strategy.contours.count = 0;
    for (SkinRule* const skin : {&strategy.upskin, &strategy.downskin}) {
        skin->overlap = 0;
        skin->narrowest = 0;
        skin->hatch = strategy.hatch;
    }
    for (HatchRule* const rule : {&strategy.hatch, &strategy.upskin.hatch, &strategy.downskin.hatch}) {
        rule->pattern = HatchPattern::lines;
        rule->distance = 0.21;
        rule->border = 0;
        rule->shortest = 0;
        rule->angle_degrees = 11;
    }
    for (int round = 0; round < rounds_within_reason(200); ++round) {
        std::vector<Layer> stack;
        for (int i = 0; i < 5; ++i)
            stack.push_back(test::random_material(random, 16));
        const std::vector<ScanLayer> below{stack[1], stack[0]};
        const std::vector<ScanLayer> above{stack[3], stack[4]};
        strategy.upskin.layers = 2;
        strategy.downskin.layers = 2;
        const Plane regions = scan(stack[2], below, above, strategy).vectors;
        ASSERT_EQ(regions.parts(), 3U);
        ScanStrategy plain = strategy;
        plain.upskin.layers = plain.downskin.layers = 0;
        const auto hatched = [&](const Layer& layer) {
            return marked(vectors_of(layer, plain), 0);
        };
        EXPECT_NEAR(marked(regions, 0) + marked(regions, 1) + marked(regions, 2), hatched(stack[2]), 1e-5)
            << round;
        const auto cut = [](const Layer& a, const Layer& b) {
            return combine(a, b, BooleanOperation::intersect);
        };
        EXPECT_NEAR(marked(regions, 0),
                    hatched(combine(stack[2], cut(stack[1], stack[0]), BooleanOperation::subtract)), 1e-5);
        EXPECT_NEAR(marked(regions, 1),
                    hatched(cut(cut(cut(stack[2], stack[0]), cut(stack[1], stack[3])), stack[4])), 1e-5);
    }
}

TEST(Scan, WaysAreAsStraightAsRoundingLeavesThem) {
    const Rounding rounding{.step_mm = 0.001};
    const std::vector<Point2> corners{{0.101, 0.203}, {9.737, 2.311}, {7.119, 12.907}, {-2.413, 10.811}};
    test::Contour ring;
    for (std::size_t side = 0; side < corners.size(); ++side)
        for (int i = 0; i < 50; ++i) {
            const Point2& a = corners[side];
            const Point2& b = corners[(side + 1) % corners.size()];
            const auto rounded = [i](double from, double to) {
                return std::round((from + i / 50.0 * (to - from)) * 1000) / 1000;
            };
            ring.push_back({rounded(a.x, b.x), rounded(a.y, b.y)});
        }
    const Layer layer = layer_of({ring});
    EXPECT_GT(ScanLayer(layer).layer().points.size(), 100U);
    const ScanLayer straight(layer, rounding);
    EXPECT_EQ(straight.layer().points.size(), corners.size());
    for (const Point2& p : layer.points)
        EXPECT_LE(distance_to(straight.layer(), p), 2 * moved_point(layer.points.span(), rounding));
    EXPECT_EQ(ScanLayer(layer_of({corners}), rounding).layer().points.size(), corners.size());
}

TEST(Scan, WhereThePartEndsAllIsSkin) {
    ScanStrategy strategy;
    strategy.upskin.layers = 2;
    strategy.downskin.layers = 3;
    const Layer layer = normal_layer({rectangle(0, 0, 10, 10)});
    const std::vector<ScanLayer> same(3, layer);
    const auto count = [&](std::size_t below, std::size_t above) {
        std::vector<bool> some;
        for (const PointArray& hatches :
             scan(layer, std::span(same).first(below), std::span(same).first(above), strategy)
                 .vectors.hatches)
            some.push_back(!hatches.empty());
        return some;
    };
    EXPECT_EQ(count(3, 2), (std::vector<bool>{false, true, false, false})); // the last one is the contour
    EXPECT_EQ(count(2, 2), (std::vector<bool>{true, false, false, false}));
    EXPECT_EQ(count(3, 1), (std::vector<bool>{false, false, true, false}));
    EXPECT_EQ(count(0, 0), (std::vector<bool>{true, false, false, false})); // what hangs is the worse
}

TEST(Scan, SkinsReachIntoTheCoreByTheOverlap) {
    ScanStrategy strategy;
    strategy.contours.count = 0;
    strategy.upskin.layers = 1;
    strategy.upskin.overlap = 0.5;
    for (HatchRule* const rule : {&strategy.hatch, &strategy.upskin.hatch}) {
        rule->pattern = HatchPattern::lines;
        rule->distance = 1;
        rule->border = 0;
    }
    const Layer layer = normal_layer({rectangle(0, 0, 10, 10)});
    const std::vector<ScanLayer> above{normal_layer({rectangle(0, 0, 4, 10)})};
    const Plane vectors = scan(layer, {}, above, strategy).vectors;
    EXPECT_NEAR(marked(vectors, 0), 40, 1e-6);
    EXPECT_NEAR(marked(vectors, 1), 65, 1e-6);
}

TEST(Scan, StripsTooNarrowAreNoSkin) {
    ScanStrategy strategy;
    strategy.upskin.layers = 1;
    strategy.upskin.narrowest = 0.05;
    const Layer layer = normal_layer({rectangle(0, 0, 10, 10)});
    const auto skin = [&](double width) {
        const std::vector<ScanLayer> above{normal_layer({rectangle(0, 0, 10 - width, 10)})};
        return scan(layer, {}, above, strategy).vectors.hatches[1].size();
    };
    EXPECT_EQ(skin(0), 0U);
    EXPECT_EQ(skin(1e-12), 0U);
    EXPECT_EQ(skin(0.04), 0U);
    EXPECT_GT(skin(0.3), 0U);
}

// The layer above has a groove, or a rib is what is left of it: both are strips from side to side.
TEST(Scan, GroovesAndRibsAreSkinFromTheNarrowestOn) {
    SkinRule rule;
    rule.layers = 1;
    const Layer layer = normal_layer({rectangle(0, 0, 10, 10)});
    for (const double width : {0.02, 0.09, 0.098, 0.101, 0.11, 0.15, 0.19, 0.21, 0.5}) {
        const std::vector<ScanLayer> grooved{
            normal_layer({rectangle(0, 0, 10, 10), reversed(rectangle(2, 5, 8, 5 + width))})};
        const Skin floor(layer, grooved, rule);
        const std::vector<ScanLayer> nothing{normal_layer({rectangle(0, 2, 10, 4)})};
        const Layer ribbed = normal_layer({rectangle(0, 2, 10, 4), rectangle(0, 7, 10, 7 + width)});
        const Skin rib(ribbed, nothing, rule);
        const double skin = width > rule.narrowest ? width : 0;
        const auto area = [](const Layer& all, const Skin& part) {
            return measure(combine(all, part.area(), BooleanOperation::intersect)).area_mm2;
        };
        EXPECT_NEAR(area(layer, floor), 6 * skin, 1e-6) << width;
        EXPECT_NEAR(area(ribbed, rib), 10 * skin, 1e-6) << width;
    }
}

// Which is to say: they are scanned as parts without skins would be by these rules.
TEST(Scan, OfSupportsGoesByTheirRulesAlone) {
    Random random(9);
    ScanStrategy strategy;
    strategy.upskin.layers = 2; // all of it would be skin
    strategy.support.contours.count = 2;
    strategy.support.contours.start = StartPoint::random;
    strategy.support.hatch.pattern = HatchPattern::chessboard;
    strategy.support.hatch.order = IslandOrder::random;
    strategy.support.hatch.distance = 0.4;
    ScanStrategy plain;
    plain.contours = strategy.support.contours;
    plain.hatch = strategy.support.hatch;
    plain.hatch.parameters.spot_mm = plain.hatch.distance; // lines of supports reach as far
    for (int round = 0; round < rounds_within_reason(50); ++round) {
        Layer layer = test::random_material(random, 16);
        layer.index = static_cast<std::uint64_t>(round);
        const Plane vectors = scan_support(layer, strategy).vectors;
        const Plane expected = vectors_of(layer, plain);
        ASSERT_EQ(vectors.parts(), support_exposures(strategy, "part").size());
        for (std::size_t i = 0; i < vectors.parts(); ++i) {
            EXPECT_EQ(vectors.polylines[i].index, layer.index);
            EXPECT_TRUE(std::equal(vectors.polylines[i].points.begin(), vectors.polylines[i].points.end(),
                                   expected.polylines[i].points.begin(), expected.polylines[i].points.end()));
            EXPECT_TRUE(same_hatches(vectors.hatches[i], expected.hatches[i]));
        }
    }
    strategy.hatch.distance = 0; // also where no support asks for it
    EXPECT_THROW(static_cast<void>(scan_support(Layer{}, strategy)), Error);
}

TEST(Scan, OfNothingIsNothing) {
    for (const Layer& layer : {Layer{}, layer_of({{{1, 1}}}, {{{0, 0}, {1, 0}}})}) {
        const Plane vectors = vectors_of(layer);
        EXPECT_EQ(vectors.parts(), exposures({}, {}).size());
        for (std::size_t i = 0; i < vectors.parts(); ++i) {
            EXPECT_EQ(vectors.polylines[i].contours(), 0U);
            EXPECT_TRUE(vectors.polylines[i].points.empty() && vectors.hatches[i].empty());
        }
    }
}

TEST(Scan, DoesNotDependOnTheOrderOfRings) {
    Random random(8);
    ScanStrategy strategy;
    strategy.contours.start = StartPoint::random;
    strategy.hatch.pattern = HatchPattern::chessboard;
    strategy.hatch.order = IslandOrder::random;
    for (int round = 0; round < rounds_within_reason(100); ++round) {
        std::vector<test::Contour> rings = contours(test::random_rings(random, 16));
        const Plane once = vectors_of(normal_layer(rings), strategy);
        std::reverse(rings.begin(), rings.end());
        const Plane again = vectors_of(normal_layer(rings), strategy);
        for (std::size_t i = 0; i < once.parts(); ++i) {
            EXPECT_TRUE(same_contours(once.polylines[i], again.polylines[i]));
            EXPECT_TRUE(same_hatches(once.hatches[i], again.hatches[i]));
        }
    }
}

TEST(Scan, WithAMemoryIsTheSame) {
    ScanStrategy strategy;
    strategy.contours.count = 2;
    strategy.upskin.layers = strategy.downskin.layers = 1;
    Random random(20261126);
    std::vector<Layer> layers;
    for (int i = 0; i < 60; ++i) {
        Layer layer =
            random.integer(0, 2) == 0 || layers.empty() ? random_material(random, 8) : layers.back();
        layer.index = static_cast<std::uint64_t>(i);
        layer.bottom = i;
        layer.z = i + 0.5;
        layer.top = i + 1;
        layers.push_back(std::move(layer));
    }
    InsetCache memory;
    for (std::size_t i = 1; i + 1 < layers.size(); ++i) {
        const std::vector<ScanLayer> below{layers[i - 1]};
        const std::vector<ScanLayer> above{layers[i + 1]};
        const Plane expected = scan(layers[i], below, above, strategy).vectors;
        const Plane found = scan(layers[i], below, above, strategy, {.cache = &memory}).vectors;
        ASSERT_EQ(found.parts(), expected.parts());
        for (std::size_t k = 0; k < found.parts(); ++k) {
            EXPECT_EQ(contours(found.polylines[k]), contours(expected.polylines[k])) << i << ", " << k;
            EXPECT_TRUE(same_hatches(found.hatches[k], expected.hatches[k])) << i << ", " << k;
            EXPECT_EQ(found.polylines[k].index, layers[i].index);
            EXPECT_EQ(found.polylines[k].top, layers[i].top);
        }
    }
}

TEST(Scan, RemembersLayersThatDifferByStraightPoints) {
    // As upright walls do, whose triangles are cut in other places on each layer.
    const auto wall = [](double t) {
        return layer_of({{{0, 0}, {10 * t, 0}, {10, 0}, {10, 10 * t}, {10, 10}, {0, 10}}});
    };
    InsetCache memory;
    const Plane first = vectors_of(wall(0.25), {}, &memory);
    const std::shared_ptr<const InsetCache::Insets> kept = memory.last();
    ASSERT_NE(kept, nullptr);
    const Plane second = vectors_of(wall(0.75), {}, &memory);
    EXPECT_EQ(memory.last(), kept);
    EXPECT_EQ(contours(first.polylines.back()), contours(second.polylines.back()));
    ASSERT_EQ(first.polylines.back().rings, 1U);
    EXPECT_EQ(first.polylines.back().contour(0).size(), 4U);
    static_cast<void>(vectors_of(layer_of({rectangle(0, 0, 10, 9)}), {}, &memory));
    EXPECT_NE(memory.last(), kept);
}

TEST(Scan, RefusesAStrategyThatIsNotRight) {
    ScanStrategy strategy;
    strategy.hatch.distance = 0;
    EXPECT_THROW(static_cast<void>(scan(Layer{}, {}, {}, strategy)), Error);
    strategy.hatch.distance = 1e-9;
    EXPECT_THROW(static_cast<void>(scan(normal_layer({rectangle(0, 0, 9, 9)}), {}, {}, strategy)), Error);
}

} // namespace
} // namespace lamella::scan_cases
