#pragma once

// Nesting for who has looked at the layer before, also where its rings are those of two operands.

#include "lamella/polygon/nesting.hpp"

#include "polygon/contacts.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/windings.hpp"

#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// The nesting by both operands together, and for each ring the windings of either just outside of its left
/// end, just inside, and below it, whatever other rings share its lowest edge there.
struct NestingWithWindings {
    Nesting nesting;
    std::vector<Windings> outside;
    std::vector<Windings> inside;
    std::vector<Windings> below;
};

/// The same as `nesting(layer)`, but what that begins with is there already: the chains of the layer, their
/// grid (where there is one), and its contacts, with a group or `none` for each ring. Rings in contact
/// with none, and not over such that are, take little time: O(log c) for c rings, and a short way down the
/// grid.
///
/// `turns`: what each ring adds to the windings; for a layer of one operand, 1 to the first.
[[nodiscard]] NestingWithWindings nesting(const Layer& layer, const MonotoneChains& chains,
                                          const std::optional<ChainGrid>& grid, const Contacts& contacts,
                                          std::span<const Windings> turns, const LayerBudget& budget = {});

} // namespace lamella
