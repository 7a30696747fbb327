#pragma once

// Pairs of crossing sides, for code that cuts them.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"
#include "polygon/orientation.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// Returns the segments of each pair that crosses properly, the smaller index first, in no order. If there
/// are more than `most`, returns some, more than `most`. Costs as much as `find_crossings`.
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossing_pairs(std::span<const Segment> segments, std::uint64_t most, const LayerBudget& budget);

/// Returns the largest number of crossings between contours of a layer that takes less than a minute to cut.
[[nodiscard]] constexpr std::uint64_t most_crossings(std::uint64_t sides) noexcept {
    return (std::uint64_t{1} << 22) + 64 * sides;
}

/// Memory for cutting at one crossing: its position on the grid and the pieces of both sides.
inline constexpr std::uint64_t bytes_of_crossing = 512;

/// Throws Error{limit} if the rings of a layer cross more often than `most_crossings` or the budget allows.
/// Crossings of segments that are collinear except for rounding do not count.
void check_crossings(const Layer& layer, const LayerBudget& budget);

/// Throws Error{limit} for more than `most_crossings`.
[[noreturn]] void refuse_crossings(std::size_t sides, const LayerBudget& budget);

} // namespace lamella
