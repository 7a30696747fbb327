#include "lamella/contour/open_gaps.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "fixtures/skip_if_slowed.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <tuple>
#include <vector>

namespace lamella {
namespace {

using test::Random;
using Points = std::vector<Point2>;

Layer layer_of(const std::vector<Points>& chains) {
    return test::normal_layer({}, chains);
}

TEST(OpenGaps, AreNoneWhereAllIsClosed) {
    EXPECT_EQ(open_gaps(test::normal_layer({Points{{0, 0}, {1, 0}, {0, 1}}})).count, 0U);
    EXPECT_EQ(open_gaps(Layer{}).count, 0U);
}

TEST(OpenGaps, AChainThatNearlyMeetsItself) {
    const OpenGaps gaps = open_gaps(layer_of({{{0, 2}, {0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 5}}}));
    EXPECT_EQ(gaps.count, 1U);
    EXPECT_EQ(gaps.longest_mm, 3);
    EXPECT_EQ(gaps.total_mm, 3);
    EXPECT_EQ(gaps.from, (Point2{0, 5}));
    EXPECT_EQ(gaps.to, (Point2{0, 2}));
}

TEST(OpenGaps, AShortPieceGoesOnInItsNeighboursNotInItself) {
    // A square with a stray piece of 0.1 in a gap of 0.5.
    const OpenGaps gaps =
        open_gaps(layer_of({{{0, 2}, {0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 2.5}}, {{0, 2.3}, {0, 2.2}}}));
    EXPECT_EQ(gaps.count, 2U);
    EXPECT_NEAR(gaps.total_mm, 0.4, 1e-12);
    EXPECT_NEAR(gaps.longest_mm, 0.2, 1e-12);
}

TEST(OpenGaps, OfChainsInOnePlaceAreFoundWithoutLookingAtAllOfThem) {
    LAMELLA_SKIP_IF_SLOWED();
    // Each end has all starts at the same distance. To compare all with all would take minutes.
    for (const Point2 step : {Point2{0, 0}, Point2{0, 1e-9}, Point2{1e-9, 0}}) {
        std::vector<Points> chains;
        for (int i = 0; i < 100'000; ++i)
            chains.push_back({{i * step.x, i * step.y}, {10, i * step.y}, {10, 10}, {0, 10}, {0, 3}});
        const OpenGaps gaps = open_gaps(layer_of(chains));
        EXPECT_EQ(gaps.count, chains.size());
        EXPECT_NEAR(gaps.total_mm, 3.0 * static_cast<double>(chains.size()), 10);
    }
}

TEST(OpenGaps, APieceAloneIsAsLongAsItsGap) {
    const OpenGaps gaps = open_gaps(layer_of({{{0, 0}, {3, 4}}}));
    EXPECT_EQ(gaps.count, 1U);
    EXPECT_EQ(gaps.total_mm, 5);
}

double length_of(const Points& chain) {
    double length = 0;
    for (std::size_t i = 1; i < chain.size(); ++i)
        length += std::hypot(chain[i].x - chain[i - 1].x, chain[i].y - chain[i - 1].y);
    return length;
}

/// By all pairs, sorted.
std::vector<double> naive_gaps(const std::vector<Points>& chains) {
    std::vector<std::tuple<double, std::size_t, std::size_t>> pairs;
    for (std::size_t from = 0; from < chains.size(); ++from)
        for (std::size_t to = 0; to < chains.size(); ++to) {
            const double d = std::hypot(chains[from].back().x - chains[to].front().x,
                                        chains[from].back().y - chains[to].front().y);
            if (from != to || 2 * d <= length_of(chains[from]))
                pairs.emplace_back(d, from, to);
        }
    std::sort(pairs.begin(), pairs.end());
    std::vector<bool> ended(chains.size());
    std::vector<bool> started(chains.size());
    std::vector<double> gaps;
    for (const auto& [d, from, to] : pairs)
        if (!ended[from] && !started[to]) {
            ended[from] = started[to] = true;
            gaps.push_back(d);
        }
    return gaps;
}

TEST(OpenGaps, AreTheClosestPairsFirst) {
    Random random(5);
    for (int trial = 0; trial < 500; ++trial) {
        std::vector<Points> chains(static_cast<std::size_t>(random.integer(1, 40)));
        for (Points& chain : chains)
            for (std::int64_t n = random.integer(2, 4); n > 0; --n)
                chain.push_back({random.real(0, 10), random.real(0, 10)});
        std::sort(chains.begin(), chains.end());
        const std::vector<double> expected = naive_gaps(chains);
        if (expected.size() < chains.size())
            continue; // a last one is left with itself
        const OpenGaps gaps = open_gaps(layer_of(chains));
        ASSERT_EQ(gaps.count, chains.size());
        double total = 0;
        for (const double gap : expected)
            total += gap;
        ASSERT_NEAR(gaps.total_mm, total, 1e-9) << trial;
        ASSERT_DOUBLE_EQ(gaps.longest_mm, *std::max_element(expected.begin(), expected.end())) << trial;
    }
}

TEST(OpenGaps, ARingInPiecesHasTheGapsThatWereCutIntoIt) {
    std::vector<Points> chains;
    constexpr int pieces = 500;
    const auto at = [](double turn) {
        return Point2{100 * std::cos(2 * std::numbers::pi * turn),
                      100 * std::sin(2 * std::numbers::pi * turn)};
    };
    for (int i = 0; i < pieces; ++i)
        chains.push_back({at((i + 0.0) / pieces), at((i + 0.5) / pieces), at((i + 0.9) / pieces)});
    const OpenGaps gaps = open_gaps(layer_of(chains));
    const double gap = 200 * std::sin(std::numbers::pi * 0.1 / pieces);
    EXPECT_EQ(gaps.count, 500U);
    EXPECT_NEAR(gaps.total_mm, pieces * gap, 1e-6);
    EXPECT_NEAR(gaps.longest_mm, gap, 1e-9);
}

TEST(OpenGaps, ManyEndsInOnePlaceComeToAnEnd) {
    std::vector<Points> chains;
    for (int i = 0; i < 20000; ++i)
        chains.push_back({{i * 1e-3, 0}, {-5, i * 1e-3}, {-1, 0}});
    const OpenGaps gaps = open_gaps(layer_of(chains));
    EXPECT_EQ(gaps.count, 20000U);
    EXPECT_GE(gaps.longest_mm, 20);
}

} // namespace
} // namespace lamella
