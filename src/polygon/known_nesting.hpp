#pragma once

// Nesting for who has looked at the layer before.

#include "lamella/polygon/nesting.hpp"

#include "polygon/contacts.hpp"
#include "polygon/monotone_chains.hpp"

namespace lamella {

/// The same as `nesting(layer)`, but what that begins with is there already: the chains of the layer, their
/// grid (null where there is none), and its contacts. Where there are none, nesting takes little time: O(c
/// log c) for c rings, and a short way down the grid for each of them.
[[nodiscard]] Nesting nesting(const Layer& layer, const MonotoneChains& chains, const ChainGrid* grid,
                              const Contacts& contacts);

} // namespace lamella
