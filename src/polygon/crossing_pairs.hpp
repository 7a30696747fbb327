#pragma once

// Which sides cross, for who cuts them there.

#include "core/layer_budget.hpp"
#include "polygon/orientation.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// The numbers of the segments of each pair that crosses properly, the smaller one first, in no order. Costs
/// as `find_crossings`; ends when there are more than `most`. Throws Error{limit} for more of them than the
/// budget has room for, each of `bytes_each`, as soon as that is known.
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossing_pairs(std::span<const Segment> segments, std::uint64_t most, std::uint64_t bytes_each,
               const LayerBudget& budget);

} // namespace lamella
