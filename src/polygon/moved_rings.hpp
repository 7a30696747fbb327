#pragma once

// Rings whose sides are moved in parallel, each by itself.

#include "lamella/contour/layer.hpp"
#include "lamella/polygon/offset.hpp"

#include "core/layer_budget.hpp"

#include <span>
#include <vector>

namespace lamella {

/// For each distance the rings of a layer, in their order, with sides moved to the right by it, to the left
/// by a negative one: of boundaries of material, outwards or inwards. Of those that are `gone` nothing is
/// left.
///
/// Moved rings may run into themselves and one another. Where the winding number of all of them is above 0 is
/// the material, grown or shrunk. Where no side came to run backwards and rings do not meet, they bound it as
/// they are. O(points) for each distance.
[[nodiscard]] std::vector<Layer> moved_rings(const Layer& layer, std::span<const double> distances,
                                             const OffsetCorners& corners,
                                             std::span<const std::vector<bool>> gone,
                                             const LayerBudget& budget = {});

/// How far from a side or a corner strips and wedges reach at least, in all directions to which it is moved.
[[nodiscard]] double surely_swept(double distance, const OffsetCorners& corners) noexcept;

} // namespace lamella
