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

/// Options of the formats png, png-zip, sl1 and sl1s: the pixels of the image, and how they map to the part.
/// The centre of the part's box is at the centre of the display.
struct ImageOptions {
    /// Size of a pixel, number of pixels, and size of the display. Two of them determine the third. The
    /// defaults are the values of the printer (sl1, sl1s). Without a printer, pixels are 0.05 mm wide, and
    /// the image is as large as the part.
    std::optional<AlongXY<double>> pixel_mm = {};
    std::optional<AlongXY<std::uint32_t>> pixels = {};
    std::optional<AlongXY<double>> display_mm = {};

    /// Orientation, as PrusaSlicer defines it: with `portrait` the display is mounted upright in the printer,
    /// and x runs from the bottom of the image to its top. Mirrored displays are seen from the other side.
    /// The defaults are the values of the printer; without a printer an image shows the layer as seen from
    /// above.
    std::optional<bool> portrait = {};
    std::optional<bool> mirror_x = {};
    std::optional<bool> mirror_y = {};

    RasterOptions raster = {};
};

/// Options of the formats sl1 and sl1s: exposure times for the printer, in seconds. The defaults suit a
/// common resin in layers of 0.05 mm.
struct ExposureOptions {
    std::optional<double> normal_s = {};
    std::optional<double> first_s = {}; ///< of the first three layers
    std::uint32_t fade_layers = 10; ///< number of layers over which the time changes from first_s to normal_s
    /// Time of creation recorded in the file, in seconds since 1970. It is constant by default so that equal
    /// layers give equal bytes.
    std::int64_t created_s = 0;
};

/// Returns the environment variable SOURCE_DATE_EPOCH, in seconds since 1970, with which reproducible builds
/// set the time (reproducible-builds.org); 0 if it is not set. Throws Error{usage} if its value is not a
/// time.
[[nodiscard]] std::int64_t source_date();

} // namespace lamella
LAMELLA_API_END
