#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/compare.hpp"
#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"
#include "lamella/polygon/simplify.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "polygon/segment_distance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace lamella {
namespace {

using test::Contour;
using test::distance_from_segment;
using test::layer_of;
using test::normal_layer;
using test::Random;
using test::rectangle;
using test::reversed;

/// How far points along `from` are from `to`, at most: its corners, and points between them.
double farthest(std::span<const Point2> from, std::span<const Point2> to, bool closed) {
    double most = 0;
    for (std::size_t i = 0; i + (closed ? 0 : 1) < from.size(); ++i)
        for (const double t : {0.0, 0.25, 0.5, 0.75}) {
            const Point2& a = from[i];
            const Point2& b = from[(i + 1) % from.size()];
            const Point2 p{a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
            double least = std::numeric_limits<double>::infinity();
            for (std::size_t j = 0; j + (closed ? 0 : 1) < to.size(); ++j)
                least = std::min(least, distance_from_segment(p, to[j], to[(j + 1) % to.size()]));
            most = std::max(most, least);
        }
    return most;
}

Contour wobbly_circle(Random& random, double x, double y, double radius, int n, double wobble) {
    Contour ring;
    for (int i = 0; i < n; ++i) {
        const double angle = 2 * std::numbers::pi * i / n;
        const double r = radius + random.real(-wobble, wobble);
        ring.push_back({x + r * std::cos(angle), y + r * std::sin(angle)});
    }
    return ring;
}

TEST(Simplify, CountsCrossingsBeforeItTakesMemoryForThem) {
    std::vector<Contour> rings; // walls across one another, each with a point to leave out
    for (int i = 0; i < 70; ++i) {
        const double at = 0.02 * i;
        rings.push_back({{-1, at}, {1, at + 1e-4}, {3, at}, {3, at + 0.01}, {-1, at + 0.01}});
        rings.push_back({{at, -1}, {at + 0.01, -1}, {at + 0.01, 3}, {at + 1e-4, 1}, {at, 3}});
    }
    const Layer layer = normal_layer(rings);
    EXPECT_EQ(simplify(layer, 1e-3).rings, layer.rings); // points between crossings stay
    test::expect_error(ErrorKind::limit, {"layer 0", "crossings of contours", "`max_memory`"},
                       [&] { static_cast<void>(simplify(layer, 1e-3, {.memory = 1 << 17})); });
    CancelFlag flag;
    flag.request();
    test::expect_error(ErrorKind::cancelled, {"cancelled"},
                       [&] { static_cast<void>(simplify(layer, 1e-3, {.cancel = &flag})); });
}

TEST(Simplify, LeavesOutPointsOnALine) {
    const Layer layer =
        normal_form(layer_of({{{0, 0}, {1, 0}, {2, 0}, {4, 0}, {4, 4}, {2, 4}, {0, 4}, {0, 1}}}));
    EXPECT_TRUE(same_contours(simplify(layer, 0), layer_of({rectangle(0, 0, 4, 4)})));
    EXPECT_TRUE(same_contours(simplify(layer, 0.1), layer_of({rectangle(0, 0, 4, 4)})));
}

TEST(Simplify, StaysWithinTheToleranceBothWays) {
    Random random(41);
    for (int round = 0; round < 200; ++round) {
        const double tolerance = random.real(0.001, 0.5);
        Contour chain;
        for (int i = 0; i < 50; ++i)
            chain.push_back({100 + 0.2 * i, random.real(0, 0.6)});
        const Layer layer = normal_form(layer_of({wobbly_circle(random, 0, 0, 10, 200, 0.2)}, {chain}));
        const Layer simple = simplify(layer, tolerance);
        ASSERT_EQ(simple.contours(), 2U);
        EXPECT_LT(simple.points.size(), layer.points.size());
        for (std::size_t i = 0; i < 2; ++i) {
            EXPECT_LE(farthest(layer.contour(i), simple.contour(i), i == 0), tolerance + 1e-12);
            EXPECT_LE(farthest(simple.contour(i), layer.contour(i), i == 0), tolerance + 1e-12);
        }
        EXPECT_EQ(simple.contour(1).front(), layer.contour(1).front());
        EXPECT_EQ(simple.contour(1).back(), layer.contour(1).back());
        EXPECT_TRUE(in_normal_form(simple));
    }
}

TEST(SimplifyEach, StaysWithinTheToleranceAndLetsNoRingVanishOrTurnOver) {
    Random random(43);
    for (int round = 0; round < 200; ++round) {
        const double tolerance = random.real(0.001, 3);
        const Layer layer = normal_form(
            layer_of({wobbly_circle(random, 0, 0, 10, 200, 0.2),
                      reversed(wobbly_circle(random, 0, 0, 1, 50, 0.2)), rectangle(20, 0, 30, 0.001)}));
        const Layer simple = simplify_each(layer, tolerance);
        ASSERT_EQ(simple.rings, 3U);
        EXPECT_LT(simple.points.size(), layer.points.size());
        for (std::size_t i = 0; i < 3; ++i) {
            EXPECT_LE(farthest(layer.contour(i), simple.contour(i), true), tolerance + 1e-12);
            EXPECT_LE(farthest(simple.contour(i), layer.contour(i), true), tolerance + 1e-12);
            EXPECT_GT(ring_area(layer.contour(i)) * ring_area(simple.contour(i)), 0);
        }
    }
    EXPECT_THROW((void)simplify_each(layer_of({}), -1), Error);
}

TEST(Simplify, NeverMakesContoursCrossTurnOverOrMovePastOthers) {
    Random random(42);
    std::size_t before = 0;
    std::size_t after = 0;
    for (int round = 0; round < 300; ++round) {
        // Thin walls: rings within rings, nearer to one another than the tolerance; and specks beside them.
        std::vector<Contour> rings;
        for (int i = 0; i < 6; ++i) {
            const Contour ring = wobbly_circle(random, 0, 0, 10 - 0.3 * i, 120, 0.1);
            rings.push_back(i % 2 == 0 ? ring : reversed(ring));
        }
        for (int i = 0; i < 20; ++i) {
            const double angle = random.real(0, 2 * std::numbers::pi);
            rings.push_back(
                wobbly_circle(random, 10.2 * std::cos(angle), 10.2 * std::sin(angle), 0.02, 5, 0.01));
        }
        const Layer layer = normal_form(layer_of(rings));
        if (find_crossings(layer).count > 0)
            continue; // specks may be upon one another
        const Nesting nest = nesting(layer);
        const Layer simple = simplify(layer, random.real(0.05, 3));
        ASSERT_EQ(find_crossings(simple).count, 0U);
        ASSERT_EQ(simple.rings, layer.rings);
        Nesting thinned = nesting(simple);
        std::sort(thinned.depth.begin(), thinned.depth.end());
        std::vector<std::uint32_t> depths = nest.depth;
        std::sort(depths.begin(), depths.end());
        ASSERT_EQ(thinned.depth, depths);
        ASSERT_EQ(std::count(thinned.kind.begin(), thinned.kind.end(), RingKind::hole),
                  std::count(nest.kind.begin(), nest.kind.end(), RingKind::hole));
        before += layer.points.size();
        after += simple.points.size();
    }
    EXPECT_GT(before, 10000U);
    EXPECT_LT(2 * after, before);
}

TEST(Simplify, StaysWithinTheToleranceAlsoWhereContoursWouldCross) {
    Random random(43);
    std::size_t put_back = 0;
    for (int round = 0; round < 300; ++round) {
        const double tolerance = random.real(0.3, 2);
        const Contour body = wobbly_circle(random, 0, 0, 8, 60, 2);
        Contour hole; // close to it all around
        for (const Point2& p : body)
            hole.insert(hole.begin(), {0.97 * p.x, 0.97 * p.y});
        const Layer layer = normal_form(layer_of({body, hole}));
        if (find_crossings(layer).count > 0)
            continue;
        const Layer simple = simplify(layer, tolerance);
        ASSERT_EQ(simple.rings, 2U);
        // In normal form the body comes first.
        for (std::size_t i = 0; i < 2; ++i) {
            ASSERT_LE(farthest(layer.contour(i), simple.contour(i), true), tolerance + 1e-12) << round;
            ASSERT_LE(farthest(simple.contour(i), layer.contour(i), true), tolerance + 1e-12) << round;
            const Layer alone =
                normal_form(layer_of({Contour(layer.contour(i).begin(), layer.contour(i).end())}));
            put_back += simple.contour(i).size() - simplify(alone, tolerance).points.size();
        }
    }
    EXPECT_GT(put_back, 100U);
}

TEST(Simplify, OfSpikesAndSpiralsTakesAReasonableNumberOfSteps) {
    LAMELLA_SKIP_IF_SLOWED();
    // The farthest points of these split off one spike, or one turn, at a time.
    constexpr int n = 300000;
    Contour zigzag;
    Contour comb;
    Contour spiral;
    for (int i = 0; i < n; ++i) {
        zigzag.push_back({1.0 * i, (i % 2 == 0 ? 1.0 : -1.0) * (n - i)});
        comb.push_back({0.5 * i, i % 2 == 0 ? 0.0 : 1.0 * n});
        const double angle = 2 * std::numbers::pi * i / 20;
        spiral.push_back({(1 + 0.01 * i) * std::cos(angle), (1 + 0.01 * i) * std::sin(angle)});
    }
    for (const Contour& contour : {zigzag, comb, spiral}) {
        const Layer layer = normal_form(layer_of({}, {contour}));
        EXPECT_TRUE(same_contours(simplify(layer, 0.01), layer)); // all of them are needed
    }
    const Layer layer = layer_of({}, {spiral});
    const Layer coarse = simplify(layer, 0.3);
    EXPECT_LT(coarse.points.size(), layer.points.size());
    EXPECT_LE(compare(layer, coarse).distance_mm, 0.3);
    EXPECT_EQ(find_crossings(coarse).count, 0U);
}

TEST(Simplify, OfWhatHasNothingToLeaveOutIsTheLayerItself) {
    const Layer layer = normal_form(layer_of({rectangle(0, 0, 4, 4)}, {{{9, 9}, {10, 10}}}));
    EXPECT_EQ(simplify(layer, 0.5).points.data(), layer.points.data());
    EXPECT_EQ(simplify(Layer{}, 0.5).contours(), 0U);
}

TEST(Simplify, KeepsARingThatIsSmallerThanTheTolerance) {
    const Layer layer = normal_form(layer_of({rectangle(0, 0, 0.1, 0.1)}));
    const Layer simple = simplify(layer, 5);
    ASSERT_EQ(simple.rings, 1U);
    EXPECT_GT(measure(simple).area_mm2, 0);
}

TEST(Simplify, ByWhatIsNoDistanceIsRefused) {
    EXPECT_THROW(static_cast<void>(simplify(Layer{}, -1)), Error);
    EXPECT_THROW(static_cast<void>(simplify(Layer{}, std::nan(""))), Error);
}

TEST(Simplify, MakesNoCrossingsBesideThousandsOfOldOnes) {
    std::vector<Contour> rings;
    for (int i = 0; i < 70; ++i) {
        rings.push_back(rectangle(i, -1, i + 0.5, 71));
        rings.push_back(rectangle(-1, i, 71, i + 0.5));
    }
    const std::uint64_t before = find_crossings(normal_layer(rings)).count;
    ASSERT_GT(before, 4096U);
    rings.push_back({{200, 0}, {210, 0}, {210, 10}, {205.2, 10}, {205.1, 9.9}, {205, 10}, {200, 10}});
    rings.push_back({{205.05, 9.97}, {205.15, 9.97}, {205.1, 10.2}}); // in its dent
    EXPECT_EQ(find_crossings(simplify(normal_layer(rings), 0.15)).count, before);
}

} // namespace
} // namespace lamella
