#include "fixtures/rounds.hpp"
#include "polygon/edge_below.hpp"
#include "polygon/left_end.hpp"
#include "polygon/plain_rings.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace lamella::edge_below_cases {
namespace {

using test::layer_of;
using test::Random;

TEST(EdgeBelow, IsTheHighestOfAllEdgesBelow) {
    Random random(301);
    std::size_t found = 0;
    for (int round = 0; round < test::rounds_within_reason(600); ++round) {
        const Layer layer = layer_of(test::nested_stars(random));
        const MonotoneChains chains(layer);
        const std::optional<ChainGrid> grid = ChainGrid::of(chains);
        ASSERT_TRUE(grid);
        const Contacts contacts = find_contacts(layer, chains, grid);
        ASSERT_EQ(contacts.groups, 0U);
        for (std::uint32_t own = 0; own < layer.rings; ++own) {
            const Point2 p = left_end(layer, chains, own).line.lo;
            double highest = -std::numeric_limits<double>::infinity();
            EdgeBelow expected;
            for (std::uint32_t ring = 0; ring < layer.rings; ++ring)
                for (std::size_t i = 0; ring != own && i < layer.contour(ring).size(); ++i) {
                    const Point2& a = layer.contour(ring)[i];
                    const Point2& b = layer.contour(ring)[(i + 1) % layer.contour(ring).size()];
                    const double y = a.y + (p.x - a.x) / (b.x - a.x) * (b.y - a.y);
                    if ((a.x <= p.x) != (b.x <= p.x) && y < p.y && y > highest) {
                        highest = y;
                        expected = {ring, a.x < b.x};
                    }
                }
            const EdgeBelow edge = edge_below(p, own, chains, *grid, contacts);
            EXPECT_TRUE(edge.sure);
            EXPECT_EQ(edge.ring, expected.ring) << round;
            if (edge.ring != Nesting::none) {
                EXPECT_EQ(edge.rightwards, expected.rightwards) << round;
                ++found;
            }
        }
    }
    EXPECT_GT(found, test::slowed ? 0U : 100U);
}

TEST(EdgeBelow, IsNotSureAboveRingsInContact) {
    const Layer layer = layer_of({test::rectangle(0, 0, 9, 2), test::rectangle(0, 2, 9, 4),
                                  test::diamond(5, 8, 1), test::diamond(20, 8, 1)});
    const MonotoneChains chains(layer);
    const std::optional<ChainGrid> grid = ChainGrid::of(chains);
    const Contacts contacts = find_contacts(layer, chains, grid);
    const EdgeBelow above = edge_below({4, 8}, 2, chains, *grid, contacts);
    EXPECT_FALSE(above.sure);
    EXPECT_EQ(above.ring, Nesting::none);
    EXPECT_TRUE(edge_below({19, 8}, 3, chains, *grid, contacts).sure);
}

} // namespace
} // namespace lamella::edge_below_cases
