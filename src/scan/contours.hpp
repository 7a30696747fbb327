#pragma once

// Orders rings for the beam, and chooses the start point of each.

#include "lamella/contour/layer.hpp"
#include "lamella/scan/strategy.hpp"

#include <cstdint>

namespace lamella {

/// Returns the rings of a layer in normal form in scanning order. The layer is divided into strips. Rings
/// with start points in the same strip follow one another, in a direction that alternates from strip to
/// strip. `number` is the number of the contour; the outermost is 1. O(n + c log c) for n points in c rings.
[[nodiscard]] Layer followed(const Layer& rings, const ContourRule& rule, std::uint32_t number,
                             std::uint64_t seed);

} // namespace lamella
