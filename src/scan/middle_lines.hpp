#pragma once

// Lines along the middle of walls that are too thin for contours.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"

#include <vector>

namespace lamella {

/// Returns the middle axes of thin areas, as open lines and as closed ones that repeat their first point at
/// the end. An area is thin where it is narrower than `width` and at least `thinnest` wide. Lines shorter
/// than half of `width` are left out. `material` must consist of rings in normal form that bound material
/// and do not cross. Lines lie within the areas, and end at most about half of `width` before the ends of the
/// areas. They deviate from the axes by at most a hundredth of `width`. The lines of an area do not depend on
/// other areas. O(n log n) for n pieces of the outlines, each half of the width long.
[[nodiscard]] std::vector<std::vector<Point2>> middle_lines(const Layer& material, double width,
                                                            double thinnest, const LayerBudget& budget = {});

} // namespace lamella
