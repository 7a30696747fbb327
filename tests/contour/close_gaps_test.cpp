#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::normal_layer;
using test::Random;
using Points = std::vector<Point2>;

const Points square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};

TEST(CloseGaps, PassesThroughWhatHasNoChains) {
    const Layer layer = normal_layer({square}, {});
    const ClosedGaps closed = close_gaps(layer, 1);
    EXPECT_EQ(closed.layer.points.data(), layer.points.data());
    EXPECT_TRUE(closed.joins.empty());
    EXPECT_EQ(close_gaps(normal_layer({}, {}), 1).layer.contours(), 0U);
}

TEST(CloseGaps, IgnoresContoursWithoutPoints) {
    // As somebody may fill the members of a layer: an empty ring, and empty chains around one that is open.
    const Points open{{0, 0.25}, {0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0.75}};
    Layer layer;
    layer.points = PointArray(open);
    layer.offsets = {0, 0, 0, 6, 6};
    layer.rings = 1;
    const ClosedGaps closed = close_gaps(layer, 0.5);
    EXPECT_EQ(closed.joins.size(), 1U);
    EXPECT_EQ(closed.layer.open_chains(), 0U);
    EXPECT_EQ(measure(closed.layer).area_mm2, 100);
    layer.points = PointArray(Points{});
    layer.offsets = {0, 0, 0};
    EXPECT_TRUE(close_gaps(layer, 0.5).joins.empty());
}

TEST(CloseGaps, ClosesAChainWhoseEndsMeet) {
    Layer layer = normal_layer({}, {{{0, 0.25}, {0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0.75}}});
    layer.index = 7;
    layer.z = 1.5;
    layer.bottom = 1;
    layer.top = 2;
    const ClosedGaps closed = close_gaps(layer, 0.5);
    ASSERT_EQ(closed.joins.size(), 1U);
    EXPECT_EQ(closed.joins[0].from, (Point2{0, 0.75}));
    EXPECT_EQ(closed.joins[0].to, (Point2{0, 0.25}));
    EXPECT_EQ(closed.joins[0].length_mm, 0.5);
    EXPECT_EQ(closed.longest_mm, 0.5);
    EXPECT_EQ(closed.total_mm, 0.5);
    EXPECT_EQ(closed.layer.rings, 1U);
    EXPECT_EQ(closed.layer.open_chains(), 0U);
    EXPECT_EQ(measure(closed.layer).area_mm2, 100);
    EXPECT_EQ(closed.layer.index, 7U);
    EXPECT_EQ(closed.layer.z, 1.5);
    EXPECT_EQ(closed.layer.bottom, 1);
    EXPECT_EQ(closed.layer.top, 2);
    EXPECT_TRUE(in_normal_form(closed.layer));
    EXPECT_TRUE(close_gaps(layer, 0.499).joins.empty());
}

TEST(CloseGaps, ClosesAGapThatIsJustAsLongWhateverItsDirection) {
    // 0.8 - 0.3 is 0.5, but 0.8 - 0.5 is more than 0.3.
    EXPECT_EQ(close_gaps(normal_layer({}, {{{5, 0}, {0.8, 0}}, {{0.3, 0}, {-5, 0}}}), 0.5).joins.size(), 1U);
    EXPECT_EQ(close_gaps(normal_layer({}, {{{0, 5}, {0, 0.8}}, {{0, 0.3}, {0, -5}}}), 0.5).joins.size(), 1U);
}

TEST(CloseGaps, OnAPlaneJoinsNoEndsOfDifferentLayers) {
    const std::vector<Layer> layers{test::normal_layer({}, {{{0, 0}, {4, 0}, {4, 4}, {0, 1}}}),
                                    test::normal_layer({}, {{{0, 0.5}, {-4, 0}, {-4, 4}}})};
    const ClosedPlane plane = close_gaps_on_plane(layers, 1);
    ASSERT_EQ(plane.layers.size(), 2U);
    EXPECT_EQ(plane.joins.size(), 1U);
    for (std::size_t i = 0; i < layers.size(); ++i)
        EXPECT_TRUE(same_contours(plane.layers[i], close_gaps(layers[i], 1).layer));
    EXPECT_EQ(plane.layers[0].rings, 1U);
    EXPECT_EQ(plane.layers[1].open_chains(), 1U);
}

TEST(CloseGaps, LeavesOutARepeatedPoint) {
    const ClosedGaps closed =
        close_gaps(normal_layer({}, {{{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}}), 0.1);
    EXPECT_TRUE(same_contours(closed.layer, normal_layer({square}, {})));
    EXPECT_EQ(closed.total_mm, 0);
}

TEST(CloseGaps, JoinsTheClosestPairsFirst) {
    // Both ends could go on with either start.
    const Layer layer = normal_layer({}, {{{0, 0}, {10, 0}}, {{10.2, 0}, {10.2, 10}}, {{10, 0.3}, {5, 5}}});
    const ClosedGaps closed = close_gaps(layer, 1);
    ASSERT_EQ(closed.joins.size(), 1U);
    EXPECT_EQ(closed.joins[0].to, (Point2{10.2, 0}));
    EXPECT_EQ(closed.layer.open_chains(), 2U);
}

TEST(CloseGaps, JoinsNoHeadsWithHeadsAndNoTailsWithTails) {
    EXPECT_TRUE(close_gaps(normal_layer({}, {{{0, 0}, {10, 0}}, {{20, 0}, {10.1, 0}}}), 1).joins.empty());
    EXPECT_TRUE(close_gaps(normal_layer({}, {{{0, 0}, {-10, 0}}, {{0.1, 0}, {10, 0}}}), 1).joins.empty());
}

TEST(CloseGaps, JoinsNothingAcrossAContour) {
    const std::vector<Points> chains{{{0, 0}, {10, 0}}, {{11, 0}, {20, 0}}};
    EXPECT_EQ(close_gaps(normal_layer({}, chains), 2).joins.size(), 1U);
    const ClosedGaps across =
        close_gaps(normal_layer({{{10.5, -5}, {10.6, -5}, {10.6, 5}, {10.5, 5}}}, chains), 2);
    EXPECT_TRUE(across.joins.empty());
    EXPECT_EQ(across.refused, 1U);
    EXPECT_EQ(across.layer.open_chains(), 2U);
    // Through a corner of another one is across, too.
    EXPECT_TRUE(close_gaps(normal_layer({{{10.5, 0}, {10.7, 3}, {10.3, 3}}}, chains), 2).joins.empty());
}

TEST(CloseGaps, AShortStraightPieceIsNoRing) {
    const ClosedGaps closed =
        close_gaps(normal_layer({}, {{{0, 0}, {1, 0}}, {{5, 5}, {6, 5}, {6.5, 5.1}}}), 2);
    EXPECT_TRUE(closed.joins.empty());
    EXPECT_EQ(closed.refused, 2U);
}

/// Rings taken apart: some segments are left out.
std::vector<Points> taken_apart(const Points& ring, Random& random, double share) {
    std::vector<bool> kept(ring.size());
    for (std::size_t i = 0; i < ring.size(); ++i)
        kept[i] = random.real(0, 1) >= share;
    kept[0] = false;
    std::vector<Points> chains;
    Points chain;
    for (std::size_t i = 1; i <= ring.size(); ++i) {
        chain.push_back(ring[i % ring.size()]);
        if (!kept[i % ring.size()]) {
            if (chain.size() > 1)
                chains.push_back(chain);
            chain.clear();
        }
    }
    return chains;
}

TEST(CloseGaps, PutsRingsTogetherThatWereTakenApart) {
    Random random(5);
    for (int round = 0; round < 500; ++round) {
        // Circles side by side of many short segments; gaps are shorter than what is between circles.
        std::vector<Points> chains;
        double area = 0;
        const int circles = 1 + round % 5;
        for (int c = 0; c < circles; ++c) {
            const int n = static_cast<int>(random.integer(40, 90));
            Points ring;
            for (int i = 0; i < n; ++i) {
                const double a = 2 * std::numbers::pi * i / n * (c % 2 == 0 ? 1 : -1);
                ring.push_back({30.0 * c + 10 * std::cos(a), 10 * std::sin(a)});
            }
            area += ring_area(ring);
            for (Points& chain : taken_apart(ring, random, 0.04))
                chains.push_back(std::move(chain));
        }
        for (std::size_t i = chains.size(); i > 1; --i)
            std::swap(chains[i - 1],
                      chains[static_cast<std::size_t>(random.integer(0, static_cast<int>(i) - 1))]);
        const ClosedGaps closed = close_gaps(normal_layer({}, chains), 5);
        ASSERT_EQ(closed.layer.open_chains(), 0U);
        ASSERT_EQ(closed.layer.rings, static_cast<std::size_t>(circles));
        EXPECT_TRUE(in_normal_form(closed.layer));
        // What the joins cut off: less than their length times the sagitta of the longest.
        EXPECT_NEAR(measure(closed.layer).area_mm2, area, closed.total_mm * closed.longest_mm);
        EXPECT_TRUE(
            std::is_sorted(closed.joins.begin(), closed.joins.end(),
                           [](const GapJoin& a, const GapJoin& b) { return a.length_mm < b.length_mm; }));
    }
}

TEST(CloseGaps, NeverLosesAPointNorMakesAnEndTwiceOnRandomLayers) {
    Random random(6);
    for (int round = 0; round < 300; ++round) {
        std::vector<Points> chains;
        std::vector<Points> rings;
        const double size = round % 3 == 0 ? 4 : 40;
        for (std::int64_t c = random.integer(1, 30); c > 0; --c) {
            Points points;
            for (std::int64_t i = random.integer(2, 8); i > 0; --i)
                points.push_back(round % 2 == 0 ? Point2{random.real(0, size), random.real(0, size)}
                                                : Point2{static_cast<double>(random.integer(0, 5)),
                                                         static_cast<double>(random.integer(0, 5))});
            points.erase(std::unique(points.begin(), points.end()), points.end());
            if (points.size() > 2 && random.integer(0, 4) == 0)
                rings.push_back(points);
            else if (points.size() > 1)
                chains.push_back(points);
        }
        const Layer layer = normal_layer(rings, chains);
        const double within = random.real(0.1, 3);
        const ClosedGaps closed = close_gaps(layer, within);
        EXPECT_TRUE(in_normal_form(closed.layer));
        std::size_t zero = 0;
        for (const GapJoin& join : closed.joins) {
            EXPECT_LE(join.length_mm, within);
            zero += join.length_mm == 0 ? 1 : 0;
        }
        EXPECT_EQ(closed.layer.points.size() + zero + closed.left_out, layer.points.size());
        // A join takes one chain away.
        EXPECT_EQ(closed.layer.open_chains() + closed.joins.size(), layer.open_chains());
        EXPECT_GE(closed.layer.rings, layer.rings);
        // What is left could not be joined: a second time changes nothing but by pairs that were refused.
        if (closed.refused == 0) {
            EXPECT_TRUE(close_gaps(closed.layer, within).joins.empty());
        }
    }
}

TEST(CloseGaps, LeavesOutAnEndWhereChainsOverlapSoThatNoSegmentsCross) {
    // A square whose sides end before they meet in a corner, and one whose sides end behind it.
    const double by = 0x1p-40;
    const Points rest{{10, 0}, {10, 10}, {0, 10}};
    const auto with_ends = [&](const Point2& first, const Point2& last) {
        Points points{first};
        points.insert(points.end(), rest.begin(), rest.end());
        points.push_back(last);
        return points;
    };
    const Points apart = with_ends({by, 0}, {0, by});
    const ClosedGaps closed = close_gaps(normal_layer({}, {apart}), 1e-4);
    EXPECT_EQ(closed.joins.size(), 1U);
    EXPECT_EQ(closed.left_out, 0U);
    EXPECT_TRUE(same_contours(closed.layer, normal_layer({apart}, {})));
    const ClosedGaps crossing = close_gaps(normal_layer({}, {with_ends({-by, 0}, {0, -by})}), 1e-4);
    EXPECT_EQ(crossing.joins.size(), 1U);
    EXPECT_EQ(crossing.left_out, 1U);
    EXPECT_TRUE(same_contours(crossing.layer, normal_layer({{{0, -by}, {10, 0}, {10, 10}, {0, 10}}}, {})));
}

TEST(CloseGaps, LeavesNoEndOutWhereTheNewSegmentWouldCrossAContour) {
    const Points one{{-0.1, 0.2}, {3.2, -0.1}};
    const Points other{{2.7, -0.1}, {6, 0.2}};
    EXPECT_EQ(close_gaps(normal_layer({}, {one, other}), 1).left_out, 1U);
    // Each of these lies between one of the two and the segment that would take its place.
    const Points below_one{{1.98, -0.05}, {2.02, -0.05}, {2.02, -0.01}, {1.98, -0.01}};
    const Points below_other{{3.88, -0.05}, {3.92, -0.05}, {3.92, -0.01}, {3.88, -0.01}};
    EXPECT_EQ(close_gaps(normal_layer({below_one}, {one, other}), 1).left_out, 1U);
    EXPECT_EQ(close_gaps(normal_layer({below_other}, {one, other}), 1).left_out, 1U);
    const ClosedGaps closed = close_gaps(normal_layer({below_one, below_other}, {one, other}), 1);
    EXPECT_EQ(closed.joins.size(), 1U);
    EXPECT_EQ(closed.left_out, 0U);
}

TEST(CloseGaps, RefusesDistancesThatAreNone) {
    for (const double within : {0.0, -1.0, std::nan(""), std::numeric_limits<double>::infinity()})
        EXPECT_THROW((void)close_gaps(normal_layer({square}, {}), within), Error);
}

TEST(CloseGaps, ManyChainsInOnePlaceAreNoTrap) {
    std::vector<Points> chains;
    for (int i = 0; i < 2000; ++i)
        chains.push_back({{0, 0}, {1, static_cast<double>(i)}, {0, 0}});
    const ClosedGaps closed = close_gaps(normal_layer({}, chains), 1e-3);
    EXPECT_GT(closed.joins.size(), 60U);
}

/// Long segments in all directions whose ends are close to many others.
Layer random_segments(int count) {
    Random random(7);
    std::vector<Points> chains;
    for (int i = 0; i < count; ++i)
        chains.push_back({{random.real(0, 1), random.real(0, 1)}, {random.real(0, 1), random.real(0, 1)}});
    return normal_layer({}, chains);
}

TEST(CloseGaps, MakesTheSameJoinsAsASearchThroughAllPairsAndSegments) {
    const Layer layer = random_segments(150);
    const auto end = [&](std::size_t chain) {
        return layer.contour(chain).back();
    };
    const auto start = [&](std::size_t chain) {
        return layer.contour(chain).front();
    };
    std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> pairs;
    for (std::size_t a = 0; a < layer.contours(); ++a)
        for (std::size_t b = 0; b < layer.contours(); ++b)
            if (a != b) // a straight chain is no ring
                pairs.push_back({std::hypot(end(a).x - start(b).x, end(a).y - start(b).y), {a, b}});
    std::sort(pairs.begin(), pairs.end());
    std::vector<std::pair<Point2, Point2>> segments;
    for (std::size_t c = 0; c < layer.contours(); ++c)
        segments.push_back({start(c), end(c)});
    const auto side = [](const Point2& a, const Point2& b, const Point2& p) {
        return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
    };
    std::vector<bool> ended(layer.contours());
    std::vector<bool> started(layer.contours());
    std::vector<GapJoin> joins;
    for (const auto& [length, pair] : pairs) {
        const Point2 from = end(pair.first);
        const Point2 to = start(pair.second);
        const bool barred = std::any_of(segments.begin(), segments.end(), [&](const auto& by) {
            return by.first != from && by.second != from && by.first != to && by.second != to &&
                   side(from, to, by.first) * side(from, to, by.second) < 0 &&
                   side(by.first, by.second, from) * side(by.first, by.second, to) < 0;
        });
        if (length > 0.1 || ended[pair.first] || started[pair.second] || barred)
            continue;
        ended[pair.first] = started[pair.second] = true;
        segments.push_back({from, to});
        joins.push_back({from, to, length});
    }
    const ClosedGaps closed = close_gaps(layer, 0.1);
    ASSERT_GT(joins.size(), 20U);
    ASSERT_EQ(closed.joins.size(), joins.size());
    for (std::size_t i = 0; i < joins.size(); ++i) {
        EXPECT_EQ(closed.joins[i].from, joins[i].from);
        EXPECT_EQ(closed.joins[i].to, joins[i].to);
    }
}

TEST(CloseGaps, EndsInTheMiddleOfALayerOnRequest) {
    CancelFlag cancel;
    cancel.request();
    try {
        (void)close_gaps(random_segments(100), 1, {.cancel = &cancel});
        ADD_FAILURE() << "it was not cancelled";
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::cancelled);
    }
}

TEST(CloseGaps, KeepsToALimitOfMemory) {
    const Layer layer = random_segments(2000);
    for (const std::uint64_t memory : {1U, 100'000U, 5'100'000U})
        try {
            (void)close_gaps(layer, 1, {.memory = memory});
            ADD_FAILURE() << "it took no more than " << memory << " bytes";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::limit) << error.what();
            EXPECT_NE(std::string(error.what()).find("layer 0"), std::string::npos) << error.what();
        }
    EXPECT_FALSE(close_gaps(layer, 1, {.memory = 20'000'000}).joins.empty());
}

TEST(CloseGaps, ManyChainsThatMeetInOnePlaceAreNoTrap) {
    // From the points of a circle to its centre and from there to others: all ends are equally far from all
    // starts.
    std::vector<Points> chains;
    constexpr int n = 3000;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n;
        chains.push_back({{std::cos(a), std::sin(a)}, {0, 0}});
        chains.push_back({{0, 0}, {2 * std::cos(a), 2 * std::sin(a)}});
    }
    const ClosedGaps closed = close_gaps(normal_layer({}, chains), 1.5);
    EXPECT_GT(closed.joins.size(), 60U);
}

} // namespace
} // namespace lamella
