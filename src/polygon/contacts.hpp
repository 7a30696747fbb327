#pragma once

// Finds rings of a layer that are in contact with one another or with themselves.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"
#include "polygon/chain_grid.hpp"
#include "polygon/monotone_chains.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace lamella {

/// The groups of rings in contact.
struct Contacts {
    static constexpr std::uint32_t none = 0xffffffff;

    /// For each ring its group, or `none` if it touches nothing, not even itself.
    std::vector<std::uint32_t> group;
    std::uint32_t groups = 0;
};

/// Finds the groups of rings in contact. Two rings are in contact if they have a point in common: they cross,
/// touch or run along each other. A ring is in contact with itself if two of its edges have more in common
/// than the vertex between them. Groups are connected by contacts, and numbered by the first of their rings.
/// The decision is exact. Open chains and points that repeat the one before them are ignored.
///
/// Usually O(chains) for layers with few contacts, because the grid finds the chains whose boxes overlap, and
/// only these chains are examined. O(n log n) for layers without a useful grid, such as long parallel
/// diagonal walls. If a layer without a useful grid has contacts, rings whose boxes overlap form one group,
/// so groups may be larger than the contacts require, but never smaller.
///
/// `grid` is the grid of these chains, if there is one.
[[nodiscard]] Contacts find_contacts(const Layer& layer, const MonotoneChains& chains,
                                     const std::optional<ChainGrid>& grid, const LayerBudget& budget = {});

} // namespace lamella
