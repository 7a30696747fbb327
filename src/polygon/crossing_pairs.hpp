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

/// Returns the pairs of segments that cross properly, in no particular order, each with the smaller index
/// first. If there are more than `most`, returns only some of them, but more than `most`. Costs as much as
/// `find_crossings`.
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossing_pairs(std::span<const Segment> segments, std::uint64_t most, const LayerBudget& budget);

/// Returns the largest number of crossings that is accepted in a layer: cutting at that many takes up to a
/// minute.
[[nodiscard]] constexpr std::uint64_t most_crossings(std::uint64_t sides) noexcept {
    return (std::uint64_t{1} << 22) + 64 * sides;
}

/// Number of bytes for cutting at one crossing: its position on the grid and the pieces of both sides.
inline constexpr std::uint64_t bytes_of_crossing = 512;

/// Throws Error{limit} if the rings of a layer cross more often than `most_crossings` or the budget allows.
/// Crossings of segments that are collinear except for rounding do not count.
void check_crossings(const Layer& layer, const LayerBudget& budget);

/// Throws Error{limit} for more than `most_crossings`.
[[noreturn]] void refuse_crossings(std::size_t sides, const LayerBudget& budget);

} // namespace lamella
