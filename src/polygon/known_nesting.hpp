#pragma once

// Nesting with intermediate results that the caller already has, also for the rings of two operands.

#include "lamella/polygon/nesting.hpp"

#include "polygon/contacts.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/windings.hpp"

#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// The nesting of the rings of both operands together, and for each ring both winding numbers just outside of
/// its left end, just inside, and below it, regardless of other rings that share its lowest edge there.
struct NestingWithWindings {
    Nesting nesting;
    std::vector<Windings> outside;
    std::vector<Windings> inside;
    std::vector<Windings> below;
};

/// Returns the same as `nesting(layer)`, given its first results: the chains of the layer, their grid (if
/// there is one), and its contacts, with a group or `none` for each ring. A ring without contacts, and not
/// above rings with contacts, costs O(log c) for c rings and a short search down the grid.
///
/// `turns` is each ring's contribution to the winding numbers; for one operand, 1 to the first.
[[nodiscard]] NestingWithWindings nesting(const Layer& layer, const MonotoneChains& chains,
                                          const std::optional<ChainGrid>& grid, const Contacts& contacts,
                                          std::span<const Windings> turns, const LayerBudget& budget = {});

} // namespace lamella
