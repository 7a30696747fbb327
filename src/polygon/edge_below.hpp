#pragma once

// Finds the highest edge below a point.

#include "lamella/polygon/nesting.hpp"

#include "polygon/chain_grid.hpp"
#include "polygon/contacts.hpp"
#include "polygon/monotone_chains.hpp"

#include <cstdint>

namespace lamella {

struct EdgeBelow {
    std::uint32_t ring = Nesting::none; ///< none if no edge passes below
    bool rightwards = true;             ///< the direction of the edge in its ring
    bool sure = true; ///< false if an edge of a ring in contact may be the highest one; `ring` is then none
};

/// Returns the highest edge below p, just to the right of p. Requires that p is the lower left end of ring
/// `own`, and that this ring is in contact with no ring and has no edge below p. Exact. Examines the cells
/// from p down to that edge.
[[nodiscard]] EdgeBelow edge_below(const Point2& p, std::uint32_t own, const MonotoneChains& chains,
                                   const ChainGrid& grid, const Contacts& contacts);

} // namespace lamella
