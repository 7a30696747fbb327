#pragma once

// Polygons as the Simple Features of the Open Geospatial Consortium define them, for formats and libraries
// that accept no others.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include "polygon/clipping_grid.hpp"

#include <vector>

namespace lamella {

/// A ring around an area, counter-clockwise, and its holes, clockwise. No ring touches itself. Rings touch
/// one another only in points that are corners of both, and do not divide the inside.
struct SimplePolygon {
    Ring outer;
    std::vector<Ring> holes;
};

/// Returns the material of a layer whose coordinates are integers (FillRule::positive) as polygons that have
/// at most points in common. So bodies that overlap or share edges are united, and rings that touch
/// themselves are divided in their common points. All coordinates of the result are integers; where rings
/// cross, their sides move by less than a unit. Throws the errors of `fill`. Costs as much as `fill`.
[[nodiscard]] std::vector<SimplePolygon> simple_polygons(const Layer& whole, const LayerLimits& limits = {});

} // namespace lamella
