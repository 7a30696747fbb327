#pragma once

// Nesting for who has looked at the layer before.

#include "lamella/polygon/nesting.hpp"

#include "polygon/contacts.hpp"
#include "polygon/monotone_chains.hpp"

namespace lamella {

/// The same as `nesting(layer)`, but faster: the chains are there, and where no rings are in contact none
/// need be told apart by their areas.
[[nodiscard]] Nesting nesting(const Layer& layer, const MonotoneChains& chains, const Contacts& contacts);

} // namespace lamella
