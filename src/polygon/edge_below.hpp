#pragma once

// What lies next below a point.

#include "polygon/chain_grid.hpp"
#include "polygon/monotone_chains.hpp"

#include <cstdint>
#include <optional>

namespace lamella {

struct EdgeBelow {
    std::uint32_t ring = 0;
    bool rightwards = true; ///< the direction of the edge in its ring
};

/// The highest edge that passes below p just to the right of it, of rings that are not in contact. p is the
/// lower left end of ring `own`, none of whose edges pass below it. Exact. It takes the cells down from p to
/// that edge.
[[nodiscard]] std::optional<EdgeBelow> edge_below(const Point2& p, std::uint32_t own,
                                                  const MonotoneChains& chains, const ChainGrid& grid);

} // namespace lamella
