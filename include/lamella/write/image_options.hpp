#pragma once

// Options for images of layers, and for the resin printers that display them.

#include "lamella/raster/image.hpp"

#include <cstdint>
#include <optional>

LAMELLA_API_BEGIN
namespace lamella {

/// A pair of values, along x and along y of the layers.
template <typename T>
struct AlongXY {
    T x;
    T y;
};

/// png, png-zip, sl1, sl1s: the image and its relation to the part. The middle of the part's box is in the
/// middle of the display.
struct ImageOptions {
    /// Any two of these three determine the third. Values not given are the printer's (sl1, sl1s); without a
    /// printer, pixels are 0.05 mm wide, and their number is that which the part needs.
    std::optional<AlongXY<double>> pixel_mm = {};
    std::optional<AlongXY<std::uint32_t>> pixels = {};
    std::optional<AlongXY<double>> display_mm = {};

    /// Orientation as PrusaSlicer defines it: `portrait` is a display that stands upright in the printer, so
    /// that x runs along the rows of an image, from below; mirrored displays are seen from the other side.
    /// Values not given are the printer's; without one an image shows the layer as seen from above.
    std::optional<bool> portrait = {};
    std::optional<bool> mirror_x = {};
    std::optional<bool> mirror_y = {};

    RasterOptions raster = {};
};

/// sl1, sl1s: exposure times for the printer, in seconds. The defaults are for a common resin in layers of
/// 0.05 mm.
struct ExposureOptions {
    std::optional<double> normal_s = {};
    std::optional<double> first_s = {}; ///< of the first three layers
    std::uint32_t fade_layers = 10; ///< number of layers in which the first exposure becomes the normal one
    /// Time of creation recorded in the file, in seconds since 1970. It is constant by default so that equal
    /// layers give equal bytes.
    std::int64_t created_s = 0;
};

/// Returns the time that reproducible builds agree upon (reproducible-builds.org): the environment variable
/// SOURCE_DATE_EPOCH, in seconds since 1970; 0 if it is not set. Throws Error{usage} if its value is not a
/// time.
[[nodiscard]] std::int64_t source_date();

} // namespace lamella
LAMELLA_API_END
