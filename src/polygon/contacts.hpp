#pragma once

// Which rings of a layer come into contact, with one another or with themselves.

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

    /// For each ring the group that it belongs to, `none` when it touches nothing, not even itself.
    std::vector<std::uint32_t> group;
    std::uint32_t groups = 0;
};

/// Two rings are in contact when they have a point in common: they cross, touch or run along each other. A
/// ring is in contact with itself when two of its edges have more in common than the vertex between them.
/// Groups are connected by contacts, and numbered by the first of their rings. Decided exactly. Open chains
/// do not count; points that repeat the one before them do not either.
///
/// Meant for layers that are clean, in O(chains) for most of them: the grid tells which of the chains' boxes
/// overlap, and those alone are looked into. O(n log n) for layers that have no grid or defeat it, such as
/// long walls aslant side by side. Where such a layer has contacts, rings whose boxes overlap are put in one
/// group: groups may be larger than contacts ask for, never smaller.
///
/// `grid`: of these chains, where there is one.
[[nodiscard]] Contacts find_contacts(const Layer& layer, const MonotoneChains& chains,
                                     const std::optional<ChainGrid>& grid, const LayerBudget& budget = {});

} // namespace lamella
