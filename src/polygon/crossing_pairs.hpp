#pragma once

// Which sides cross, for who cuts them there.

#include "core/layer_budget.hpp"
#include "polygon/orientation.hpp"

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// Returns the numbers of the segments of each pair that crosses properly, the smaller one first, in no
/// order; of more than `most` pairs, more than `most`, but not all. Costs as `find_crossings`.
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossing_pairs(std::span<const Segment> segments, std::uint64_t most, const LayerBudget& budget);

} // namespace lamella
