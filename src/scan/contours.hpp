#pragma once

// Rings in the order in which a beam follows them, each from where it begins.

#include "lamella/contour/layer.hpp"
#include "lamella/scan/strategy.hpp"

#include <cstdint>

namespace lamella {

/// Of a layer in normal form. Rings whose beginnings lie in the same strip of the layer follow one another,
/// and strips go back and forth. `number`: of the contour, from outside. O(n + c log c) for n points in c
/// rings.
[[nodiscard]] Layer followed(const Layer& rings, const ContourRule& rule, std::uint32_t number,
                             std::uint64_t seed);

} // namespace lamella
