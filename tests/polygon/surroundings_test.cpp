#include "lamella/contour/measure.hpp"
#include "lamella/polygon/nesting.hpp"

#include "fixtures/rounds.hpp"
#include "polygon/plain_rings.hpp"
#include "polygon/surroundings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace lamella::surroundings_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;

std::vector<LeftEnd> ends_of(const Layer& layer, const MonotoneChains& chains) {
    std::vector<LeftEnd> ends;
    for (std::size_t i = 0; i < layer.rings; ++i)
        ends.push_back(left_end(layer, chains, i));
    return ends;
}

std::vector<std::uint32_t> all_of(const Layer& layer) {
    std::vector<std::uint32_t> rings(layer.rings);
    std::iota(rings.begin(), rings.end(), 0U);
    return rings;
}

std::vector<std::uint32_t> ranks_by_area(const Layer& layer) {
    std::vector<std::uint32_t> largest_first = all_of(layer);
    std::stable_sort(largest_first.begin(), largest_first.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::abs(ring_area(layer.contour(a))) > std::abs(ring_area(layer.contour(b)));
    });
    std::vector<std::uint32_t> ranks(layer.rings);
    for (std::uint32_t i = 0; i < ranks.size(); ++i)
        ranks[largest_first[i]] = i + 1;
    return ranks;
}

/// A search for all rings of a layer.
struct Searched {
    explicit Searched(const std::vector<Contour>& rings) : layer(layer_of(rings)) {}

    Layer layer;
    MonotoneChains chains{layer};
    std::vector<LeftEnd> ends = ends_of(layer, chains);
    RingCopies copies{layer, ends, find_contacts(layer, chains, ChainGrid::of(chains))};
    std::vector<Windings> turns = std::vector<Windings>(layer.rings, {1, 0});
    std::vector<std::uint32_t> all = all_of(layer);
    std::vector<std::uint32_t> ranks = ranks_by_area(layer);
    SurroundingsSearch search{chains, ends, copies, turns, all, ranks, all};
};

TEST(Surroundings, HaveTheWindingNumberOfAllOtherRings) {
    Random random(321);
    for (int round = 0; round < test::rounds_within_reason(500); ++round) {
        const Searched found(round % 2 == 0 ? test::tangled_rings(random, false)
                                            : test::nested_stars(random));
        for (const std::uint32_t ring : found.all) {
            const Point2& p = found.ends[ring].line.lo;
            int winding = 0; // the ring itself does not run around its own left end
            for (const std::uint32_t other : found.all)
                winding += other == ring ? 0 : test::plain_winding(found.layer.contour(other), p);
            const Surroundings around = found.search.find(ring);
            EXPECT_EQ(around.winding, (Windings{winding, 0})) << round;
            EXPECT_EQ(around.below_all, (Windings{winding, 0})) << round << ": nothing coincides";
        }
    }
}

TEST(Surroundings, HaveTheHighestEdgeBelow) {
    Random random(322);
    for (int round = 0; round < test::rounds_within_reason(500); ++round) {
        const Searched found(test::nested_stars(random));
        for (const std::uint32_t own : found.all) {
            const Point2& p = found.ends[own].line.lo;
            double highest = -std::numeric_limits<double>::infinity();
            std::uint32_t expected = Nesting::none;
            for (const std::uint32_t ring : found.all)
                for (std::size_t i = 0; ring != own && i < found.layer.contour(ring).size(); ++i) {
                    const Point2& a = found.layer.contour(ring)[i];
                    const Point2& b = found.layer.contour(ring)[(i + 1) % found.layer.contour(ring).size()];
                    const double y = a.y + (p.x - a.x) / (b.x - a.x) * (b.y - a.y);
                    if ((a.x <= p.x) != (b.x <= p.x) && y < p.y && y > highest) {
                        highest = y;
                        expected = ring;
                    }
                }
            const RingEdge* const below = found.search.find(own).below;
            EXPECT_EQ(below == nullptr ? Nesting::none : below->ring, expected) << round;
        }
    }
}

TEST(Surroundings, OrderCoincidentEdgesByArea) {
    // All begin at one corner and share their lowest edge: each lies in the larger ones.
    const Searched found(
        {test::rectangle(0, 0, 4, 4), test::rectangle(0, 0, 9, 9), test::rectangle(0, 0, 2, 2)});
    EXPECT_EQ(found.search.find(1).winding, (Windings{0, 0}));
    EXPECT_EQ(found.search.find(0).winding, (Windings{1, 0}));
    EXPECT_EQ(found.search.find(2).winding, (Windings{2, 0}));
    for (const std::uint32_t ring : found.all)
        EXPECT_EQ(found.search.find(ring).below_all, Windings{}) << ring;
}

} // namespace
} // namespace lamella::surroundings_cases
