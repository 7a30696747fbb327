#pragma once

// Where layers may have been cut that a format has rounded.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/slicing/plan.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace lamella {

/// The cuts of layers, each as far above (1) or below (-1) its own as a format may have moved it, or where
/// they are (0).
struct MovedCuts {
    MovedCuts(std::span<const Layer> layers, const Rounding& rounding, PlaneRule rule, double direction);

    Plan plan;
    std::vector<std::size_t> plane; ///< of each layer
};

} // namespace lamella
