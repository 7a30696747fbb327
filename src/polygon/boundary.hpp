#pragma once

// Rings around the material of an arrangement.

#include "polygon/arrangement.hpp"
#include "polygon/clipping_grid.hpp"
#include "polygon/material.hpp"

#include <span>
#include <vector>

namespace lamella {

/// Returns the boundary of the material in an arrangement on this grid: bodies counter-clockwise, holes
/// clockwise. Rings that meet at a point are joined so that each keeps its own wedge of material. Points that
/// were corners of the given rings get their original coordinates; other points lie on the grid. If the rings
/// would then cross, all points lie on the grid instead. The rings do not cross.
[[nodiscard]] std::vector<Ring> boundary(const Arrangement& arrangement, const Material& material,
                                         const ClippingGrid& grid);

/// Returns the boundary of the area where the winding number of the rings satisfies the rule; see `boundary`.
[[nodiscard]] std::vector<Ring> filled(std::span<const std::span<const Point2>> rings, FillRule rule,
                                       const ClippingGrid& grid, const LayerBudget& budget = {});

} // namespace lamella
