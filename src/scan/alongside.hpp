#pragma once

// Finds rings of two layers that are nearly the same.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// Means no ring.
inline constexpr std::uint32_t no_ring = 0xffffffff;

/// Returns for each ring of layer `a` a ring of layer `b` that runs alongside it, or `no_ring`. Two rings run
/// alongside each other if two points can follow them once around and are never farther apart than `within`
/// mm. Each ring is paired at most once. The segment between the two points sweeps each area that is inside
/// of only one of the two rings. So no point of this area is farther than `within` from either ring. All
/// pairs in the result are correct, but some pairs may be missed. O(points) for layers in normal form in
/// which few rings have nearly the same box.
[[nodiscard]] std::vector<std::uint32_t> rings_alongside(const Layer& a, const Layer& b, double within,
                                                         const LayerBudget& budget = {});

} // namespace lamella
