#pragma once

// The result of drawing a row of an image.

#include "lamella/raster/image.hpp"

#include <cstdint>
#include <span>

namespace lamella {

struct DrawnRow {
    std::span<const PixelRun> runs; ///< valid until the next row is drawn
    double covered;                 ///< in pixels
    std::uint32_t times;            ///< number of equal rows from this one on
    double unseen = 0;              ///< area, in pixels, of material in these rows that no pixel shows
};

} // namespace lamella
