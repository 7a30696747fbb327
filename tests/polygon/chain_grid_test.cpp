#include "fixtures/rounds.hpp"
#include "polygon/chain_grid.hpp"
#include "polygon/plain_rings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <optional>
#include <vector>

namespace lamella::chain_grid_cases {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;

std::vector<Contour> rings_of(Random& random, int round) {
    std::vector<Contour> rings =
        round % 2 == 0 ? test::nested_stars(random) : test::tangled_rings(random, round % 4 == 1);
    if (round % 3 == 0)
        rings.push_back(test::regular_polygon(500, 60)); // of several pieces
    return rings;
}

/// Returns whether two ascending lists have an item in common.
template <class A, class B>
bool in_common(const A& a, const B& b) {
    std::vector<std::size_t> common;
    std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(common));
    return !common.empty();
}

TEST(ChainGrid, HasEachSegmentInOnePieceAndEachPieceInItsCells) {
    Random random(271);
    for (int round = 0; round < test::rounds_within_reason(200); ++round) {
        const Layer layer = layer_of(rings_of(random, round));
        const MonotoneChains chains(layer);
        const double reach = round % 5 == 0 ? 0.5 : 0;
        const std::optional<ChainGrid> grid = ChainGrid::of(chains, reach);
        ASSERT_TRUE(grid);
        std::vector<std::uint64_t> segments(layer.rings, 0);
        std::vector<std::vector<std::size_t>> cells(grid->pieces().size());
        for (std::uint32_t i = 0; i < grid->pieces().size(); ++i) {
            const Chain& piece = grid->pieces()[i];
            for (const Chain& chain : grid->chains(piece)) {
                segments[piece.ring] += chain.segments;
                for (std::uint32_t k = 0; k <= chain.segments; ++k) {
                    const Box2 box = Box2::of(chains.point(chain, k)).grown(reach);
                    EXPECT_TRUE(grid->box(i).x0 <= box.x0 && box.x1 <= grid->box(i).x1) << round;
                    EXPECT_TRUE(grid->box(i).y0 <= box.y0 && box.y1 <= grid->box(i).y1) << round;
                }
            }
        }
        for (std::size_t ring = 0; ring < layer.rings; ++ring)
            EXPECT_EQ(segments[ring], layer.contour(ring).size()) << round;
        for (std::size_t cell = 0; cell < grid->cells().cells(); ++cell) {
            const auto here = grid->cells().in_cell(cell);
            EXPECT_TRUE(std::is_sorted(here.begin(), here.end()));
            for (const std::uint32_t piece : here)
                cells[piece].push_back(cell);
        }
        for (std::uint32_t i = 0; i < cells.size(); ++i)
            for (std::uint32_t k = 0; k < i; ++k)
                if (grid->box(i).meets(grid->box(k))) {
                    EXPECT_TRUE(in_common(cells[i], cells[k])) << round;
                }
    }
}

TEST(ChainGrid, SuspectsEachPointThatLiesInAnotherRing) {
    Random random(272);
    std::size_t within = 0;
    std::size_t free = 0;
    for (int round = 0; round < test::rounds_within_reason(300); ++round) {
        const Layer layer = layer_of(rings_of(random, round));
        const MonotoneChains chains(layer);
        const std::optional<ChainGrid> grid = ChainGrid::of(chains);
        ASSERT_TRUE(grid);
        for (std::uint32_t ring = 0; ring < layer.rings; ++ring) {
            const Point2& p = layer.contour(ring).front();
            bool in_another = false;
            for (std::size_t other = 0; other < layer.rings; ++other)
                in_another =
                    in_another || (other != ring && test::plain_winding(layer.contour(other), p) != 0);
            const bool suspected = grid->surrounded(p, ring);
            EXPECT_TRUE(suspected || !in_another) << round;
            within += in_another ? 1 : 0;
            free += suspected ? 0 : 1;
        }
    }
    EXPECT_GT(within, test::slowed ? 0U : 100U);
    EXPECT_GT(free, test::slowed ? 0U : 100U);
}

TEST(ChainGrid, IsNoneForLayersThatItCannotDivide) {
    const Layer empty;
    EXPECT_FALSE(ChainGrid::of(MonotoneChains(empty)));
    constexpr double far = std::numeric_limits<double>::max();
    const Layer endless = layer_of({{{-far, 0}, {far, 0}, {0, 1}}});
    EXPECT_FALSE(ChainGrid::of(MonotoneChains(endless)));
}

TEST(ChainGrid, IsFullWhereManyRingsLieInOneAnother) {
    std::vector<Contour> nest;
    std::vector<Contour> apart;
    for (int i = 0; i < 1000; ++i) {
        const double size = 0.01 + 1e-5 * i;
        nest.push_back(test::rectangle(-size, -size, size, size));
        apart.push_back(test::rectangle(3 * i, 0, 3 * i + 1, 1));
    }
    nest.push_back(test::rectangle(-90, -90, 90, 90));
    const Layer nested = layer_of(nest);
    const Layer row = layer_of(apart);
    const MonotoneChains chains_of_nest(nested);
    const MonotoneChains chains_of_row(row);
    EXPECT_TRUE(ChainGrid::of(chains_of_nest)->full());
    EXPECT_FALSE(ChainGrid::of(chains_of_row)->full());
}

} // namespace
} // namespace lamella::chain_grid_cases
