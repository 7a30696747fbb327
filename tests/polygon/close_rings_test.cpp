#include "fixtures/layers.hpp"
#include "polygon/chain_grid.hpp"
#include "polygon/close_rings.hpp"
#include "polygon/monotone_chains.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace lamella::close_rings_cases {
namespace {

using test::layer_of;
using test::rectangle;

/// Groups of rings of which those from `second` on belong to the second operand.
std::vector<std::uint32_t> groups_of(const Layer& layer, std::size_t second) {
    std::vector<Windings> turns(layer.rings, {1, 0});
    for (std::size_t i = second; i < layer.rings; ++i)
        turns[i] = {0, 1};
    const MonotoneChains chains(layer);
    const std::optional<ChainGrid> grid = ChainGrid::of(chains);
    return with_close_rings(layer, turns, find_contacts(layer, chains, grid)).group;
}

TEST(CloseRings, AreThoseOfBothOperandsWithinRoundingOfOneAnother) {
    constexpr std::uint32_t none = Contacts::none;
    constexpr double near = 1e-12;
    constexpr double far = 1e-6;
    const auto wall = rectangle(0, 0, 10, 10);
    EXPECT_EQ(groups_of(layer_of({wall, rectangle(10 + near, 0, 20, 10)}), 1),
              (std::vector<std::uint32_t>{0, 0}));
    EXPECT_EQ(groups_of(layer_of({wall, rectangle(2, near, 5, 4)}), 1), (std::vector<std::uint32_t>{0, 0}));
    EXPECT_EQ(groups_of(layer_of({wall, rectangle(10 + far, 0, 20, 10)}), 1),
              (std::vector<std::uint32_t>{none, none}));
    EXPECT_EQ(groups_of(layer_of({wall, rectangle(10 + near, 0, 20, 10)}), 2),
              (std::vector<std::uint32_t>{none, none}))
        << "both of the first operand";
    EXPECT_EQ(groups_of(layer_of({rectangle(-30, 0, -20, 10), wall, rectangle(-20, 3, -15, 4),
                                  rectangle(10 + near, 0, 20, 10), rectangle(40, 0, 50, 10)}),
                        3),
              (std::vector<std::uint32_t>{0, 1, 0, 1, none}));
}

} // namespace
} // namespace lamella::close_rings_cases
