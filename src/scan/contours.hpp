#pragma once

// Orders rings for the beam, and chooses the start point of each.

#include "lamella/contour/layer.hpp"
#include "lamella/scan/strategy.hpp"

#include <cstdint>

namespace lamella {

/// Returns the rings of a layer in normal form in scanning order. Rings with start points in the same strip
/// of the layer follow one another, in alternating directions from strip to strip. `number` is the index of
/// the contour, from outside. O(n + c log c) for n points in c rings.
[[nodiscard]] Layer followed(const Layer& rings, const ContourRule& rule, std::uint32_t number,
                             std::uint64_t seed);

} // namespace lamella
