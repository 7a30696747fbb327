#pragma once

// Lines that fill an area, in the order in which a beam follows them.

#include "lamella/contour/layer.hpp"
#include "lamella/scan/strategy.hpp"

#include <cstdint>

namespace lamella {

/// Two points each, as Layer::hatches. `area`: rings that bound it, none of which cross; its index says how
/// far the lines are turned, and with the seed in which order islands come. Throws what HatchLines throws,
/// and Error{limit} for more than 2^24 islands or stripes.
[[nodiscard]] PointArray hatch(const Layer& area, const HatchRule& rule, std::uint64_t seed);

} // namespace lamella
