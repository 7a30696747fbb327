#pragma once

// The grey values of pixels.

#include "lamella/raster/image.hpp"

namespace lamella {

/// Throws Error{usage} if `gamma` or `grey_values` define no values.
void check_grey(const RasterOptions& options);

/// Returns the values that `gamma` or `grey_values` define. The options must pass `check_grey`.
[[nodiscard]] GreyValues values_of(const RasterOptions& options);

} // namespace lamella
