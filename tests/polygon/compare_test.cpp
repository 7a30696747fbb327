#include "lamella/polygon/compare.hpp"

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
    for (const Contour& ring : rings) {
        for (const Point2& p : ring)
            builder.add_point(p);
        builder.end_contour(true);
    }
    for (const Contour& chain : chains) {
        for (const Point2& p : chain)
            builder.add_point(p);
        builder.end_contour(false);
    }
    return builder.finish(0, 0, 0, 1);
}

const Contour square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};

TEST(Compare, FindsNothingBetweenEqualLayers) {
    const LayerDifference found = compare(layer_with({square}), layer_with({square}));
    EXPECT_TRUE(found.same);
    EXPECT_TRUE(found.within(0));
    EXPECT_EQ(found.distance_mm, 0);
}

TEST(Compare, TellsHowFarACornerWasMovedAndWhere) {
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

TEST(Compare, AnOpenChainIsNoRing) {
    const Contour around{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}};
    EXPECT_FALSE(compare(layer_with({square}), layer_with({}, {around})).within(0.1));
}

TEST(Compare, NothingIsInfinitelyFarFromSomething) {
    EXPECT_EQ(compare(layer_with({square}), layer_with({})).distance_mm,
              std::numeric_limits<double>::infinity());
    EXPECT_TRUE(compare(layer_with({}), layer_with({})).same);
}

Layer at(double z, double thickness, Layer layer) {
    layer.z = z;
    layer.bottom = z - thickness / 2;
    layer.top = z + thickness / 2;
    return layer;
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

TEST(CompareStacks, TellsOfLayersThatAreCutElsewhereBetweenTheSameHeights) {
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

TEST(CompareStacks, ALayerWithoutContoursNeedsNoPartner) {
    const LayerStack empty{at(1, 1, layer_with({}))};
    EXPECT_TRUE(compare(RoundedLayers{empty}, {}).planes.empty());
}

TEST(Compare, AgreesWithLookingAtEverySegment) {
    std::mt19937_64 random(4);
    std::uniform_real_distribution<double> place(0, 50);
    for (int round = 0; round < 60; ++round) {
        std::vector<Contour> rings[2];
        for (std::vector<Contour>& some : rings)
            for (int ring = 0; ring < 5; ++ring) {
                Contour points;
                for (int i = 0; i < 3 + round; ++i)
                    points.push_back({place(random), place(random)});
                some.push_back(points);
            }
        const auto farthest = [](const std::vector<Contour>& from, const std::vector<Contour>& to) {
            double largest = 0;
            for (const Contour& ring : from)
                for (const Point2& p : ring) {
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
        EXPECT_NEAR(compare(layer_with(rings[0]), layer_with(rings[1])).distance_mm, expected, 1e-9);
    }
}

} // namespace
} // namespace lamella
