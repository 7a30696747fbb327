#pragma once

// The clipping library (polyclipping, that is Clipper 6), for what it does better than we could: offsets.

#include "polygon/clipping_grid.hpp"

#include <span>
#include <vector>

namespace lamella {

/// The boundary of the rings' bodies after their sides have been moved outwards by `distance`, inwards by a
/// negative one. Corners stay corners as long as they do not move by more than twice the distance; sharper
/// ones are cut off there. The rings wind around each place once or not at all.
[[nodiscard]] std::vector<Ring> grown(std::span<const std::span<const Point2>> rings, double distance,
                                      const ClippingGrid& grid);

} // namespace lamella
