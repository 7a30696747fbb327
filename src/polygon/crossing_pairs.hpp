#pragma once

// Which sides cross, for who cuts them there.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"
#include "polygon/orientation.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// Returns the numbers of the segments of each pair that crosses properly, the smaller one first, in no
/// order; of more than `most` pairs, more than `most`, but not all. Costs as `find_crossings`.
[[nodiscard]] std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossing_pairs(std::span<const Segment> segments, std::uint64_t most, const LayerBudget& budget);

/// How often sides of contours of a layer may cross: what takes less than a minute to cut at one another.
[[nodiscard]] constexpr std::uint64_t most_crossings(std::uint64_t sides) noexcept {
    return (std::uint64_t{1} << 22) + 64 * sides;
}

/// What cutting takes for each crossing: its place on the grid, and the pieces of both sides.
inline constexpr std::uint64_t bytes_of_crossing = 512;

/// Throws Error{limit} if the rings of a layer cross more often than `most_crossings` or than the budget has
/// room for. Segments that lie on one line except for rounding do not count.
void check_crossings(const Layer& layer, const LayerBudget& budget);

/// Throws Error{limit} for more than `most_crossings`.
[[noreturn]] void refuse_crossings(std::size_t sides, const LayerBudget& budget);

} // namespace lamella
