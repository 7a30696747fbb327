#pragma once

// Finds rings of two layers that are nearly the same.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// Means no ring.
inline constexpr std::uint32_t no_ring = 0xffffffff;

/// Returns for each ring of a layer a ring of another layer that can be followed in step with it so that the
/// two points are never farther apart than `within` mm, or `no_ring`. Each ring is paired at most once. An
/// area inside of only one of the two rings was swept by the segment between the two points, so it is no
/// farther from either ring. The result is certain, but not complete: some pairs may be missed. O(points) for
/// layers in normal form whose rings have few others beside them with nearly the same box.
[[nodiscard]] std::vector<std::uint32_t> rings_alongside(const Layer& a, const Layer& b, double within,
                                                         const LayerBudget& budget = {});

} // namespace lamella
