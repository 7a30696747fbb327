#pragma once

// Finds rings of two operands that are closer to one another than coordinates are rounded.

#include "lamella/contour/layer.hpp"

#include "polygon/contacts.hpp"
#include "polygon/windings.hpp"

#include <vector>

namespace lamella {

/// Returns the contacts with groups joined in which a ring of the first operand comes within four units of
/// the grid (ClippingGrid) of a ring of the second. No ring passes between such rings without being close to
/// them, so a group still has one winding number around it. O(points) for layers with few close sides; if
/// there are many, all rings may form one group.
[[nodiscard]] Contacts with_close_rings(const Layer& layer, const std::vector<Windings>& turns,
                                        const Contacts& contacts);

} // namespace lamella
