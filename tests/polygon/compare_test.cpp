#include "lamella/core/error.hpp"
#include "lamella/polygon/compare.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace lamella {
namespace {

using Contour = std::vector<Point2>;

Layer layer_with(const std::vector<Contour>& rings, const std::vector<Contour>& chains = {}) {
    LayerBuilder builder;
    for (const Contour& ring : rings)
        builder.add_contour(ring, true);
    for (const Contour& chain : chains)
        builder.add_contour(chain, false);
    return builder.finish(0, 0, 0, 1);
}

Layer at(double z, double thickness, Layer layer) {
    layer.z = z;
    layer.bottom = z - thickness / 2;
    layer.top = z + thickness / 2;
    return layer;
}

const Contour square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};

TEST(Compare, FindsNothingBetweenEqualLayers) {
    const LayerDifference found = compare(layer_with({square}), layer_with({square}));
    EXPECT_TRUE(found.same);
    EXPECT_TRUE(found.within(0));
    EXPECT_EQ(found.distance_mm, 0);
}

TEST(Compare, ReportsHowFarACornerWasMovedAndWhere) {
    Contour moved = square;
    moved[2] = {10.3, 10.4};
    const LayerDifference found = compare(layer_with({square}), layer_with({moved}));
    EXPECT_FALSE(found.same);
    EXPECT_NEAR(found.distance_mm, 0.5, 1e-12);
    EXPECT_EQ(found.where, (Point2{10.3, 10.4}));
    EXPECT_FALSE(found.within(0.49));
    EXPECT_TRUE(found.within(0.5 + 1e-9));
}

TEST(Compare, SidesWithMorePointsAreTheSameContour) {
    Contour finer = square;
    finer.insert(finer.begin() + 1, {{2, 0}, {7, 0}});
    const LayerDifference found = compare(layer_with({square}), layer_with({finer}));
    EXPECT_FALSE(found.same);
    EXPECT_TRUE(found.within(1e-9));
}

TEST(Compare, ARingThatRunsTheOtherWayIsAnotherOne) {
    Contour turned = square;
    std::reverse(turned.begin(), turned.end());
    const LayerDifference found = compare(layer_with({square}), layer_with({turned}));
    EXPECT_EQ(found.distance_mm, 0);
    EXPECT_FALSE(found.within(0.1));
}

TEST(Compare, TwoRingsThatRunTheOtherWayAreOthersAlsoWhereTheirAreasCancel) {
    const Contour plate{{0, 0}, {20, 0}, {20, 20}, {0, 20}};
    const Contour hole{{2, 2}, {2, 7}, {7, 7}, {7, 2}};
    const Contour island{{30, 2}, {35, 2}, {35, 7}, {30, 7}};
    const auto turned = [](Contour contour) {
        std::reverse(contour.begin(), contour.end());
        return contour;
    };
    const LayerDifference found =
        compare(layer_with({plate, hole, island}), layer_with({plate, turned(hole), turned(island)}));
    EXPECT_EQ(found.distance_mm, 0);
    EXPECT_EQ(found.first.area_mm2, found.second.area_mm2);
    EXPECT_FALSE(found.within(0.1));
}

TEST(Compare, SidesAreComparedNotOnlyTheirCorners) {
    // Teeth of a wheel, and the gaps between them: all corners are shared.
    constexpr int teeth = 8;
    const auto wheel = [](int first) {
        std::vector<Contour> rings;
        for (int tooth = 0; tooth < teeth; ++tooth) {
            const auto corner = [&](double radius, int step) {
                const double angle = (2 * tooth + first + step) * 3.14159265358979 / teeth;
                return Point2{radius * std::cos(angle), radius * std::sin(angle)};
            };
            rings.push_back({corner(9, 0), corner(10, 0), corner(10, 1), corner(9, 1)});
        }
        return layer_with(rings);
    };
    const LayerDifference found = compare(wheel(0), wheel(1));
    EXPECT_NEAR(found.first.area_mm2, found.second.area_mm2, 1e-9);
    EXPECT_GT(found.distance_mm, 0.5);
    EXPECT_FALSE(found.within(0.4));
    EXPECT_FALSE(compare(RoundedLayers{LayerStack{at(1, 1, wheel(0))}}, {LayerStack{at(1, 1, wheel(1))}}, 0.4)
                     .planes.at(0)
                     .agree);
    EXPECT_TRUE(compare(wheel(0), wheel(2)).within(1e-9));
}

TEST(Compare, FindsTheLargestDistanceBetweenCornersToAThousandth) {
    // A triangle over a square: its slanted sides are farthest where they are beside the corners.
    const LayerDifference found =
        compare(layer_with({square}), layer_with({{{0, 0}, {10, 0}, {10, 10}, {3, 10}, {0, 7}}}));
    EXPECT_NEAR(found.distance_mm, std::hypot(1.5, 1.5), 2e-3);
    const LayerDifference bump = // no corner of either is so far from the other
        compare(layer_with({{{0, 0}, {9, 0}, {9, 1}, {0, 1}}}),
                layer_with({{{0, 0}, {9, 0}, {9, 1}, {8, 1}, {8, 0.01}, {1, 0.01}, {1, 1}, {0, 1}}}));
    EXPECT_NEAR(bump.distance_mm, 0.99, 2e-3);
}

TEST(Compare, AnOpenChainIsNoRing) {
    const Contour around{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}};
    EXPECT_FALSE(compare(layer_with({square}), layer_with({}, {around})).within(0.1));
}

TEST(Compare, NothingIsInfinitelyFarFromSomething) {
    EXPECT_EQ(compare(layer_with({square}), layer_with({})).distance_mm,
              std::numeric_limits<double>::infinity());
    EXPECT_TRUE(compare(layer_with({}), layer_with({})).same);
}

LayerStack squares(const std::vector<double>& heights, double thickness) {
    LayerStack stack;
    for (const double z : heights)
        stack.push_back(at(z, thickness, layer_with({square})));
    return stack;
}

TEST(CompareStacks, PlanesBelongTogetherAsFarAsEitherFormatRounds) {
    const LayerStack exact = squares({100.05, 100.15}, 0.1);
    const LayerStack rounded = squares({100.05 + 3e-6, 100.15 - 3e-6}, 0.1);
    const Rounding single{.single_precision = true};
    EXPECT_EQ(compare(RoundedLayers{exact}, {rounded}).planes.size(), 4U);
    for (const StackComparison& found : {compare(RoundedLayers{exact}, {rounded, single}),
                                         compare(RoundedLayers{rounded, single}, {exact})}) {
        ASSERT_EQ(found.planes.size(), 2U);
        EXPECT_TRUE(found.planes[0].agree && found.planes[1].agree);
        EXPECT_EQ(found.planes[1].first, 1U);
        EXPECT_EQ(found.planes[1].second, 1U);
    }
}

TEST(CompareStacks, ALayerBelongsToTheNearestOneAlsoWhereLayersAreThinnerThanTheStep) {
    const LayerStack all = squares({1, 1.0001, 1.0002}, 0.0001);
    const LayerStack without_first = squares({1.0001, 1.0002}, 0.0001);
    const StackComparison found = compare(RoundedLayers{all, text_rounding}, {without_first, text_rounding});
    ASSERT_EQ(found.planes.size(), 3U);
    EXPECT_FALSE(found.planes[0].second.has_value());
    EXPECT_FALSE(found.planes[0].agree);
    EXPECT_EQ(found.planes[2].second, 1U);
}

TEST(CompareStacks, GrantsContoursWhatBothFormatsRound) {
    LayerStack moved = squares({1}, 1);
    Contour wider = square;
    wider[2] = {10.0005, 10};
    moved[0] = at(1, 1, layer_with({wider}));
    const LayerStack exact = squares({1}, 1);
    EXPECT_FALSE(compare(RoundedLayers{exact}, {moved}).planes[0].agree);
    EXPECT_TRUE(compare(RoundedLayers{exact}, {moved, text_rounding}).planes[0].agree);
    EXPECT_FALSE(compare(RoundedLayers{exact}, {moved, text_rounding}, 0.0001).planes[0].agree);
    EXPECT_NEAR(compare(RoundedLayers{exact, text_rounding}, {moved, text_rounding}).tolerance_mm,
                0.001 * std::sqrt(2.0), 1e-12);
}

TEST(CompareStacks, ReportsLayersThatAreCutElsewhereBetweenTheSameHeights) {
    const LayerStack middle = squares({0.5, 1.5}, 1);
    LayerStack low = middle;
    for (Layer& layer : low)
        layer.z = layer.bottom;
    EXPECT_TRUE(compare(RoundedLayers{middle}, {low}).cut_apart);
    EXPECT_FALSE(compare(RoundedLayers{middle}, {middle}).cut_apart);
    EXPECT_FALSE(compare(RoundedLayers{middle}, {squares({2.5}, 1)}).cut_apart);
    EXPECT_FALSE(compare(RoundedLayers{middle}, {}).cut_apart);
    low.back() = middle.back(); // one layer belongs to another one
    EXPECT_FALSE(compare(RoundedLayers{middle}, {low}).cut_apart);
}

TEST(CompareStacks, RefusesToleranceBelowNothing) {
    const LayerStack some = squares({1}, 1);
    for (const double tolerance : {-1.0, std::numeric_limits<double>::quiet_NaN()})
        test::expect_error(ErrorKind::usage, {"must be 0 or more"},
                           [&] { static_cast<void>(compare(RoundedLayers{some}, {some}, tolerance)); });
}

TEST(CompareStacks, ALayerWithoutContoursNeedsNoPartner) {
    const LayerStack empty{at(1, 1, layer_with({}))};
    EXPECT_TRUE(compare(RoundedLayers{empty}, {}).planes.empty());
}

TEST(Compare, AgreesWithLookingAtEverySegment) {
    std::mt19937_64 random(4);
    constexpr double size = 50;
    constexpr double longest = size * 1.4143; // of all sides
    constexpr std::size_t samples = 32;       // of each
    std::uniform_real_distribution<double> place(0, size);
    for (int round = 0; round < 60; ++round) {
        std::vector<Contour> rings[2];
        for (std::vector<Contour>& some : rings)
            for (int ring = 0; ring < 5; ++ring) {
                Contour points;
                for (int i = 0; i < 3 + round / 3; ++i)
                    points.push_back({place(random), place(random)});
                some.push_back(points);
            }
        const auto farthest = [](const std::vector<Contour>& from, const std::vector<Contour>& to) {
            double largest = 0;
            for (const Contour& ring : from)
                for (std::size_t k = 0; k < samples * ring.size(); ++k) {
                    const Point2& begin = ring[k / samples];
                    const Point2& end = ring[(k / samples + 1) % ring.size()];
                    const double along = static_cast<double>(k % samples) / samples;
                    const Point2 p{begin.x + along * (end.x - begin.x), begin.y + along * (end.y - begin.y)};
                    double nearest = std::numeric_limits<double>::infinity();
                    for (const Contour& other : to)
                        for (std::size_t i = 0; i < other.size(); ++i) {
                            const Point2& a = other[i];
                            const Point2& b = other[(i + 1) % other.size()];
                            const double dx = b.x - a.x;
                            const double dy = b.y - a.y;
                            const double t = std::clamp(
                                ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy), 0.0, 1.0);
                            nearest = std::min(nearest, std::hypot(p.x - a.x - t * dx, p.y - a.y - t * dy));
                        }
                    largest = std::max(largest, nearest);
                }
            return largest;
        };
        const double expected = std::max(farthest(rings[0], rings[1]), farthest(rings[1], rings[0]));
        const double found = compare(layer_with(rings[0]), layer_with(rings[1])).distance_mm;
        EXPECT_GE(found, expected * 0.998);
        EXPECT_LE(found, expected + longest / samples / 2); // between samples it may be that much farther
    }
}

} // namespace
} // namespace lamella
