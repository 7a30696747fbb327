#pragma once

// Previews of parts in the files of resin printers, before black.

#include "raster/relief.hpp"
#include "slices/images/binary_fields.hpp"

#include <cstdint>
#include <string>

namespace lamella {

/// Returns the image in this size, row after row, with 5 bits of red, 6 of green and 5 of blue for each
/// pixel.
[[nodiscard]] std::string preview_565(const ColourImage& whole, std::uint32_t width, std::uint32_t height,
                                      ByteOrder order);

/// Returns the image in this size as .ctb stores it: runs of pixels with 5 bits for each colour.
[[nodiscard]] std::string preview_runs(const ColourImage& whole, std::uint32_t width, std::uint32_t height);

} // namespace lamella
