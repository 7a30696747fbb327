#pragma once

// Lines along the middle of walls that are too thin for contours.

#include "lamella/contour/layer.hpp"

#include "core/layer_budget.hpp"

#include <vector>

namespace lamella {

/// The middle axis of thin places, as open lines and as closed ones whose first point comes again at the end:
/// of places that are narrower than `width`, where they are at least `thinnest` wide, and lines at least half
/// as long as that width. `places`: rings in normal form that bound material, none of which cross. Lines lie
/// within them, end about half of the width before their ends or nearer, and are straight to a hundredth of
/// the width. For any place the same lines, whatever else there is. O(n log n) for n pieces of the outlines
/// half of the width long.
[[nodiscard]] std::vector<std::vector<Point2>> middle_lines(const Layer& positions, double width,
                                                            double thinnest, const LayerBudget& budget = {});

} // namespace lamella
