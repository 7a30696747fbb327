#pragma once

// The grey values of pixels.

#include "lamella/raster/image.hpp"

#include <array>
#include <cstdint>

namespace lamella {

/// The value of a pixel, by its coverage in steps of 1/255.
using GreyValues = std::array<std::uint8_t, 256>;

/// Throws Error{usage} if `gamma` or `grey_curve` define no values.
void check_grey(const RasterOptions& options);

/// Returns the values that `gamma` or `grey_curve` define. The options must pass `check_grey`.
[[nodiscard]] GreyValues grey_values(const RasterOptions& options);

} // namespace lamella
