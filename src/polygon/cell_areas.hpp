#pragma once

// Areas of the cells into which the overlaid rings of two operands divide the plane, by winding numbers.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"
#include "polygon/contacts.hpp"
#include "polygon/crossing_pairs.hpp"
#include "polygon/known_nesting.hpp"
#include "polygon/windings.hpp"

#include <span>
#include <vector>

namespace lamella {

/// The area in which both operands have these winding numbers.
struct CellArea {
    Windings windings;
    double mm2 = 0;
};

/// Returns the areas of all pairs of winding numbers that occur, except for those outside of all rings, by
/// ascending numbers. Only numbers of rings in contact are rounded, to the grid of `fill`. Areas so thin that
/// this rounding may have made them are left out. `turns` is each ring's contribution to the winding numbers
/// of its inside, which may be any numbers. O(n + (m + k) log m) for n points and k crossings of rings in
/// contact, which have m points.
[[nodiscard]] std::vector<CellArea> cell_areas(const Layer& layer, std::span<const Windings> turns,
                                               const Contacts& contacts, const NestingWithWindings& nest,
                                               const LayerBudget& budget, const CrossingLimit& most);

} // namespace lamella
