#pragma once

// What lies next below a point.

#include "lamella/polygon/nesting.hpp"

#include "polygon/chain_grid.hpp"
#include "polygon/contacts.hpp"
#include "polygon/monotone_chains.hpp"

#include <cstdint>

namespace lamella {

struct EdgeBelow {
    std::uint32_t ring = Nesting::none; ///< none where no edge passes below
    bool rightwards = true;             ///< the direction of the edge in its ring
    bool sure = true; ///< false where edges of rings in contact may be the highest ones: none is told then
};

/// The highest edge that passes below p just to the right of it. p is the lower left end of ring `own`, which
/// is in contact with none, and none of whose edges pass below it. Exact. It takes the cells down from p to
/// that edge.
[[nodiscard]] EdgeBelow edge_below(const Point2& p, std::uint32_t own, const MonotoneChains& chains,
                                   const ChainGrid& grid, const Contacts& contacts);

} // namespace lamella
