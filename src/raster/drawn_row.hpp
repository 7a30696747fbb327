#pragma once

// What becomes of a row of a picture.

#include "lamella/raster/picture.hpp"

#include <cstdint>
#include <span>

namespace lamella {

struct DrawnRow {
    std::span<const PixelRun> runs; ///< they live until the next row is drawn
    double covered;                 ///< pixels
    std::uint32_t times;            ///< so many rows from there on look the same
};

} // namespace lamella
