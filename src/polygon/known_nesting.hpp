#pragma once

// Nesting for callers that already have its intermediate results, also for the rings of two operands.

#include "lamella/polygon/nesting.hpp"

#include "polygon/contacts.hpp"
#include "polygon/crossing_pairs.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/windings.hpp"

#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// The nesting of the rings of both operands together. For each ring it has the winding numbers of both
/// operands just outside of its left end, just inside, and below, where `below` is below all rings that share
/// its lowest edge there.
struct NestingWithWindings {
    Nesting nesting;
    std::vector<Windings> outside;
    std::vector<Windings> inside;
    std::vector<Windings> below;
};

/// Returns the result of `nesting(layer)`, given the chains of the layer, their grid (if there is one), and
/// its contacts, with a group or `none` for each ring. A ring without contacts that is not above rings with
/// contacts costs O(log c) for c rings and a short search down the grid.
///
/// `turns` is each ring's contribution to the winding numbers; for one operand, it is 1 for the first and 0
/// for the second. Throws Error{limit} if left ends of rings lie at many crossing edges, and the rings cross
/// more than `most` times.
[[nodiscard]] NestingWithWindings nesting(const Layer& layer, const MonotoneChains& chains,
                                          const std::optional<ChainGrid>& grid, const Contacts& contacts,
                                          std::span<const Windings> turns, const LayerBudget& budget = {},
                                          const CrossingLimit& most = most_crossings);

} // namespace lamella
