#pragma once

// Pairs of crossing sides, for code that cuts them.

#include "lamella/contour/layer.hpp"
#include "lamella/polygon/crossings.hpp"

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

/// Finds crossings like `find_crossings`, but a pair of segments counts only if each end is farther than
/// `clear_mm` from the line of the other segment.
[[nodiscard]] Crossings find_clear_crossings(const Layer& layer, std::size_t keep, std::uint64_t enough,
                                             double clear_mm, const LayerLimits& limits = {});

/// A limit to the number of crossings between contours of a layer, by the number of sides.
struct CrossingLimit {
    std::uint64_t of_any_layer;
    std::uint64_t per_side;

    [[nodiscard]] constexpr std::uint64_t operator()(std::uint64_t sides) const noexcept {
        return of_any_layer + per_side * sides;
    }
};

/// The largest number of crossings that is accepted in a layer: cutting at that many takes up to a minute.
inline constexpr CrossingLimit most_crossings{std::uint64_t{1} << 22, 64};

/// Number of bytes for cutting at one crossing: its position on the grid and the pieces of both sides.
inline constexpr std::uint64_t bytes_of_crossing = 512;

/// Throws Error{limit} if the rings of a layer cross more often than a limit or the budget allows. Crossings
/// of segments that are collinear except for rounding do not count.
void check_crossings(const Layer& layer, const LayerBudget& budget, const CrossingLimit& most);

/// Throws Error{limit} for more crossings than the limit.
[[noreturn]] void refuse_crossings(std::size_t sides, const LayerBudget& budget, const CrossingLimit& most);

} // namespace lamella
