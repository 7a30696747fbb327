#pragma once

// Rings in the opposite direction: material where the winding number was below 0.

#include "lamella/contour/layer.hpp"

namespace lamella {

/// Returns the rings of a layer reversed, without its open chains.
[[nodiscard]] Layer with_rings_reversed(const Layer& layer);

} // namespace lamella
