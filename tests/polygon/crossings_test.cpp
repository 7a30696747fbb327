#include "lamella/polygon/crossings.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "polygon/orientation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace lamella {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::rectangle;

using Key = std::tuple<std::uint64_t, std::uint64_t, std::uint64_t, std::uint64_t>;

Key key(const Crossing& c) {
    return {c.contour_a, c.segment_a, c.contour_b, c.segment_b};
}

/// All crossings of a layer with small integer coordinates, by looking at all pairs.
std::vector<Key> by_all_pairs(const Layer& layer) {
    struct Line {
        std::uint64_t contour;
        std::uint64_t segment;
        Point2 a;
        Point2 b;
    };
    std::vector<Line> lines;
    for (std::size_t c = 0; c < layer.contours(); ++c) {
        const auto contour = layer.contour(c);
        for (std::size_t i = 0; i + (layer.closed(c) ? 0 : 1) < contour.size(); ++i)
            lines.push_back({c, i, contour[i], contour[(i + 1) % contour.size()]});
    }
    const auto sign = [](const Point2& a, const Point2& b, const Point2& c) {
        const double d = (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x); // exact for small integers
        return (d > 0) - (d < 0);
    };
    std::vector<Key> result;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t j = i + 1; j < lines.size(); ++j) {
            const Line& s = lines[i];
            const Line& t = lines[j];
            if (sign(s.a, s.b, t.a) * sign(s.a, s.b, t.b) < 0 &&
                sign(t.a, t.b, s.a) * sign(t.a, t.b, s.b) < 0)
                result.emplace_back(s.contour, s.segment, t.contour, t.segment);
        }
    return result;
}

std::vector<Key> keys(const Crossings& found) {
    std::vector<Key> result;
    for (const Crossing& crossing : found.first)
        result.push_back(key(crossing));
    return result;
}

void expect_same_as_all_pairs(const Layer& layer) {
    std::vector<Key> expected = by_all_pairs(layer);
    const Crossings all = find_crossings(layer, expected.size() + 1);
    ASSERT_EQ(all.count, expected.size());
    ASSERT_EQ(keys(all), expected);
    const Crossings few = find_crossings(layer, 3);
    ASSERT_EQ(few.count, expected.size());
    expected.resize(std::min<std::size_t>(3, expected.size()));
    ASSERT_EQ(keys(few), expected);
}

Layer moved(const Layer& layer, double scale, double dx, double dy) {
    std::vector<Point2> points(layer.points.begin(), layer.points.end());
    for (Point2& p : points)
        p = {p.x * scale + dx, p.y * scale + dy};
    Layer result = layer;
    result.points = PointArray(std::move(points));
    return result;
}

/// Long thin walls side by side along a diagonal: each as long as the layer.
std::vector<Contour> slanted_walls(int n) {
    std::vector<Contour> walls;
    for (int i = 0; i < n; ++i) {
        const double x = 4.0 * i;
        walls.push_back({{x, 0}, {x + 2, 0}, {x + 2 + 4.0 * n, 4.0 * n}, {x + 4.0 * n, 4.0 * n}});
    }
    return walls;
}

TEST(Crossings, ReportTheSegmentsAndThePlace) {
    const Layer layer = layer_of({rectangle(0, 0, 10, 10), rectangle(5, 2, 15, 4)});
    const Crossings found = find_crossings(layer);
    ASSERT_EQ(found.count, 2U);
    ASSERT_EQ(keys(found), (std::vector<Key>{{0, 1, 1, 0}, {0, 1, 1, 2}}));
    EXPECT_EQ(found.first[0].at, (Point2{10, 2}));
    EXPECT_EQ(found.first[1].at, (Point2{10, 4}));
}

TEST(Crossings, OfARingWithItselfAreFound) {
    const Layer bow_tie = layer_of({{{0, 0}, {10, 10}, {10, 0}, {0, 10}}});
    const Crossings found = find_crossings(bow_tie);
    ASSERT_EQ(found.count, 1U);
    EXPECT_EQ(key(found.first[0]), Key(0, 0, 0, 2));
    EXPECT_EQ(found.first[0].at, (Point2{5, 5}));
}

TEST(Crossings, OfNothingAreNone) {
    EXPECT_EQ(find_crossings(Layer{}).count, 0U);
    EXPECT_EQ(find_crossings(layer_of({{{1, 1}}, {{2, 2}, {2, 2}}})).count, 0U);
    EXPECT_EQ(find_crossings(layer_of({rectangle(0, 0, 1, 1)}), 0).count, 0U);
}

TEST(Crossings, AreCountedAlsoWhenNoneAreKept) {
    const Crossings found = find_crossings(layer_of({rectangle(0, 0, 4, 4), rectangle(1, 1, 5, 5)}), 0);
    EXPECT_EQ(found.count, 2U);
    EXPECT_TRUE(found.first.empty());
}

/// Lines of two points each, anywhere in a square.
std::vector<Contour> chords(std::size_t n) {
    Random random(5);
    const auto point = [&] {
        return Point2{random.real(0, 100), random.real(0, 100)};
    };
    std::vector<Contour> lines(n);
    for (Contour& line : lines)
        line = {point(), point()};
    return lines;
}

TEST(Crossings, AreNoLongerLookedForOnceThereAreEnough) {
    const Layer layer = layer_of({}, chords(1000));
    const Crossings all = find_crossings(layer, 10);
    ASSERT_GT(all.count, 50'000U);
    const Crossings some = find_crossings(layer, 10, 1000);
    EXPECT_GE(some.count, 1000U);
    EXPECT_LT(some.count, 2000U);
    EXPECT_EQ(keys(some), keys(find_crossings(layer, 10, 1000))) << "the same ones each time";
    EXPECT_EQ(some.first.size(), 10U);
    EXPECT_EQ(find_crossings(layer, 10, all.count + 1).count, all.count);
}

TEST(Crossings, ContoursThatTouchDoNotCross) {
    // Corner to corner, corner to edge, edge on edge, the same edges twice.
    EXPECT_EQ(find_crossings(layer_of({rectangle(0, 0, 2, 2), rectangle(2, 2, 4, 4)})).count, 0U);
    EXPECT_EQ(find_crossings(layer_of({rectangle(0, 0, 2, 2), test::diamond(3, 1, 1)})).count, 0U);
    EXPECT_EQ(find_crossings(layer_of({rectangle(0, 0, 2, 2), rectangle(2, 1, 4, 9)})).count, 0U);
    EXPECT_EQ(find_crossings(layer_of({rectangle(0, 0, 2, 2), rectangle(0, 0, 2, 2)})).count, 0U);
}

TEST(Crossings, AChainDoesNotWrapAround) {
    const Contour hook{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
    const Contour stroke{{-1, 5}, {1, 5}}; // through the way back of the hook
    EXPECT_EQ(find_crossings(layer_of({hook}, {stroke})).count, 1U);
    EXPECT_EQ(find_crossings(layer_of({}, {hook, stroke})).count, 0U);
}

TEST(Crossings, ArePairsNotPlaces) {
    std::vector<Contour> star;
    for (int i = 0; i < 8; ++i) {
        const double angle = std::numbers::pi * (i + 0.5) / 8;
        const double x = std::round(1000 * std::cos(angle));
        const double y = std::round(1000 * std::sin(angle));
        star.push_back({{-x, -y}, {x, y}});
    }
    EXPECT_EQ(find_crossings(layer_of({}, star)).count, 28U);
}

// Segments that are all but parallel, whose computed crossing lies beyond the end of one of them.
TEST(Crossings, NearCornersAreFoundInTheCellOfTheCorner) {
    Random random(17);
    for (int round = 0; round < 2000; ++round) {
        const Contour around = test::regular_polygon(41, 10);
        const auto corner = static_cast<std::size_t>(random.integer(0, 40));
        const Point2& a = around[corner];
        const Point2& b = around[(corner + 1) % around.size()];
        const double share = std::ldexp(1, -static_cast<int>(random.integer(1, 60)));
        const Point2 touching{a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
        const auto anywhere = [&random] {
            return random.real(-9, 9);
        };
        const Contour within{touching, {anywhere(), anywhere()}, {anywhere(), anywhere()}};
        std::uint64_t expected = 0;
        for (std::size_t i = 0; i < around.size(); ++i)
            for (std::size_t k = 0; k < within.size(); ++k)
                expected += cross(segment_between(around[i], around[(i + 1) % around.size()]),
                                  segment_between(within[k], within[(k + 1) % within.size()]))
                                ? 1U
                                : 0U;
        ASSERT_EQ(find_crossings(layer_of({around, within})).count, expected) << round;
    }
}

TEST(Crossings, AreThoseOfAllPairsOnRandomIntegers) {
    Random random(3);
    for (int round = 0; round < 300; ++round) {
        // Few different coordinates make many touches and overlaps, many make few.
        const std::int64_t range = round % 3 == 0 ? 6 : round % 3 == 1 ? 40 : 1000;
        std::vector<Contour> rings;
        std::vector<Contour> chains;
        for (std::int64_t c = random.integer(1, 6); c > 0; --c) {
            Contour contour;
            for (std::int64_t i = random.integer(1, 60); i > 0; --i)
                contour.push_back({static_cast<double>(random.integer(-range, range)),
                                   static_cast<double>(random.integer(-range, range))});
            (random.integer(0, 3) == 0 ? chains : rings).push_back(contour);
        }
        ASSERT_NO_FATAL_FAILURE(expect_same_as_all_pairs(layer_of(rings, chains))) << round;
    }
}

TEST(Crossings, AreThoseOfAllPairsAmongShortAndLongSegments) {
    Random random(4);
    for (int round = 0; round < 20; ++round) {
        std::vector<Contour> chains;
        for (int i = 0; i < 800; ++i) {
            // Segments of all lengths from 1 to 2^15, most of them near the origin.
            const std::int64_t length = std::int64_t{1} << random.integer(0, 15);
            const std::int64_t spread = std::int64_t{1} << random.integer(4, 14);
            const auto x = static_cast<double>(random.integer(0, spread));
            const auto y = static_cast<double>(random.integer(0, spread));
            chains.push_back({{x, y},
                              {x + static_cast<double>(random.integer(-length, length)),
                               y + static_cast<double>(random.integer(-length, length))}});
        }
        ASSERT_NO_FATAL_FAILURE(expect_same_as_all_pairs(layer_of({}, chains))) << round;
    }
}

TEST(Crossings, AreThoseOfAllPairsAmongLongSlantedSegments) {
    Random random(5);
    for (int round = 0; round < 10; ++round) {
        std::vector<Contour> chains;
        for (int i = 0; i < 500; ++i) {
            const auto x = static_cast<double>(3 * i + random.integer(-2, 2));
            const auto tilt = static_cast<double>(round < 5 ? 0 : random.integer(-3, 3));
            chains.push_back({{x, static_cast<double>(random.integer(0, 9))}, {x + 4000 + tilt, 4000}});
        }
        for (int i = 0; i < 3 * (round % 5); ++i)
            chains.push_back({{static_cast<double>(random.integer(0, 4000)), 1},
                              {static_cast<double>(random.integer(0, 4000)), 3999}});
        ASSERT_NO_FATAL_FAILURE(expect_same_as_all_pairs(layer_of({}, chains))) << round;
    }
}

TEST(Crossings, AreThoseOfAllPairsInFans) {
    Random random(9);
    for (int round = 0; round < 24; ++round) {
        // From a short stretch to a long one, in eight directions, with strays of any length across.
        std::vector<Contour> chains;
        const auto add = [&](std::int64_t x0, std::int64_t y0, std::int64_t x1, std::int64_t y1) {
            Contour chain{{static_cast<double>(x0), static_cast<double>(y0)},
                          {static_cast<double>(x1), static_cast<double>(y1)}};
            for (Point2& p : chain) {
                p.x *= round % 2 == 0 ? 1 : -1;
                if (round % 4 >= 2)
                    std::swap(p.x, p.y);
            }
            chains.push_back(chain);
        };
        for (std::int64_t i = 0; i < 500; ++i)
            add(random.integer(0, 40), 2 * i + random.integer(-1, 1), 9000 + random.integer(0, 40),
                (round % 3 - 1) * 4000 + 40 * i + random.integer(-30, 30));
        for (std::int64_t i = 0; i < 5 * (round % 5); ++i)
            add(random.integer(0, 9000), random.integer(-4000, 20000), random.integer(0, 9000),
                random.integer(-4000, 20000));
        ASSERT_NO_FATAL_FAILURE(expect_same_as_all_pairs(layer_of({}, chains))) << round;
    }
}

TEST(Crossings, DoNotChangeWithPlaceAndScale) {
    Random random(6);
    std::vector<Contour> rings;
    for (int c = 0; c < 20; ++c) {
        Contour ring;
        for (int i = 0; i < 50; ++i)
            ring.push_back(
                {static_cast<double>(random.integer(0, 4000)), static_cast<double>(random.integer(0, 900))});
        rings.push_back(ring);
    }
    const Layer layer = layer_of(rings);
    const std::uint64_t count = find_crossings(layer).count;
    EXPECT_EQ(count, by_all_pairs(layer).size());
    for (const double scale : {0x1p-1060, 0x1p-300, 0x1p-40, 0x1p60, 0x1p1011})
        EXPECT_EQ(find_crossings(moved(layer, scale, 0, 0)).count, count) << scale;
    for (const double shift : {0x1p30, -0x1p40, 0x1p52})
        EXPECT_EQ(find_crossings(moved(layer, 1, shift, -shift)).count, count) << shift;
}

TEST(Crossings, OfAStrayLineThroughManyWallsAreAllFound) {
    constexpr int n = 10000;
    const std::vector<Contour> walls = slanted_walls(n);
    EXPECT_EQ(find_crossings(layer_of(walls)).count, 0U);
    EXPECT_EQ(find_crossings(layer_of(walls, {{{0, 2.0 * n + 1}, {8.0 * n, 2.0 * n + 2}}})).count, 2U * n);
}

TEST(Crossings, OfManyLongWallsWithTheirNeighboursAreFoundAmongNeighbours) {
    LAMELLA_SKIP_IF_SLOWED();
    // Every wall crosses the one beside it, so that each has a part in a crossing; to look at all pairs of
    // half a million would take longer than a test may.
    constexpr int n = 250000;
    constexpr double length = 4.0 * n;
    for (const double slope : {1.0, 0.0, -0.375}) {
        std::vector<Contour> walls;
        for (int i = 0; i < n; ++i) {
            const double y = 4.0 * i;
            walls.push_back({{0, y}, {length, y + slope * length}});
            walls.push_back({{0, y + 2}, {length, y - 1 + slope * length}});
        }
        const Crossings found = find_crossings(layer_of({}, walls), 2);
        ASSERT_EQ(found.count, static_cast<std::uint64_t>(n)) << slope;
        EXPECT_EQ(keys(found), (std::vector<Key>{{0, 0, 1, 0}, {2, 0, 3, 0}})) << slope;
    }
}

TEST(Crossings, OfManyLinesThatFanOutAreFoundAmongNeighbours) {
    LAMELLA_SKIP_IF_SLOWED();
    // No common direction sets these apart; each crosses one of those beside it.
    constexpr int n = 200000;
    std::vector<Contour> narrow;
    std::vector<Contour> round;
    for (int i = 0; i < n; ++i) {
        const double beside = i + (i % 2 == 0 ? 0.6 : -0.6);
        const double from = 2 * std::numbers::pi * i / n;
        const double to = 2 * std::numbers::pi * beside / n;
        narrow.push_back({{0, 1.0 * i / n}, {100, 100 * beside / n}});
        round.push_back({{std::cos(from), std::sin(from)}, {100 * std::cos(to), 100 * std::sin(to)}});
    }
    for (const std::vector<Contour>& lines : {narrow, round}) {
        const Crossings found = find_crossings(layer_of({}, lines), 2);
        EXPECT_EQ(found.count, n / 2U);
        EXPECT_EQ(keys(found), (std::vector<Key>{{0, 0, 1, 0}, {2, 0, 3, 0}}));
    }
}

TEST(Crossings, OfFineDetailInALargeFrameAreAllFound) {
    // 10,000 small diamonds in a corner of a frame a million times their size; each overlaps its neighbours.
    std::vector<Contour> rings{rectangle(-9, -9, 1e6, 1e6)};
    constexpr int n = 100;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            rings.push_back(test::diamond(2 * i, 2 * j, 1.25));
    // Next neighbours cross in two places, farther ones do not reach one another.
    EXPECT_EQ(find_crossings(layer_of(rings)).count, 2U * 2U * n * (n - 1));
}

TEST(Crossings, OfManySegmentsThroughOnePointAreNone) {
    // A star with 20,000 spikes that all come to the same centre.
    constexpr int n = 20000;
    Contour star;
    for (int i = 0; i < n; ++i) {
        star.push_back({0, 0});
        for (const double part : {0.25, 0.75}) {
            const double angle = 2 * std::numbers::pi * (i + part) / n;
            star.push_back({100 * std::cos(angle), 100 * std::sin(angle)});
        }
    }
    EXPECT_EQ(find_crossings(layer_of({star})).count, 0U);
}

} // namespace
} // namespace lamella
