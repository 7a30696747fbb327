#pragma once

// Rings of one layer and of another one that are nearly the same.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// The number of no ring.
inline constexpr std::uint32_t no_ring = 0xffffffff;

/// For each ring of a layer one of another layer that can be followed alongside, step by step, so that both
/// are never farther apart than `within` mm, or `no_ring`; each is alongside one ring at most. What is inside
/// of one of the two only was swept by the way between them, so it is no farther from either. (That the
/// shortest way is found is not sought, nor all pairs: what is found is certain.) O(points) for layers in
/// normal form whose rings have few others beside them with nearly the same box.
[[nodiscard]] std::vector<std::uint32_t> rings_alongside(const Layer& a, const Layer& b, double within,
                                                         const LayerBudget& budget = {});

} // namespace lamella
