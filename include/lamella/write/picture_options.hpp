#pragma once

// How layers become pictures, and how a resin printer shows them.

#include "lamella/raster/picture.hpp"

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

/// png, png-zip, sl1, sl1s: the picture and what it shows. The middle of the part's box is shown in the
/// middle of the display.
struct PictureOptions {
    /// Of these three, two tell the third. What is not given is the printer's (sl1, sl1s); without a printer,
    /// pixels are 0.05 mm wide and there are as many as the part needs.
    std::optional<AlongXY<double>> pixel_mm = {};
    std::optional<AlongXY<std::uint32_t>> pixels = {};
    std::optional<AlongXY<double>> display_mm = {};

    /// As PrusaSlicer has them: a display that stands upright in the printer, so that x runs along the rows
    /// of a picture, from below; and mirrored for being seen from the other side. What is not given is the
    /// printer's; without one a picture shows the layer as it is seen from above.
    std::optional<bool> portrait = {};
    std::optional<bool> mirror_x = {};
    std::optional<bool> mirror_y = {};

    RasterOptions raster = {};
};

/// sl1, sl1s: what the printer is told, in seconds. The defaults are for a common resin in layers of
/// 0.05 mm.
struct ExposureOptions {
    std::optional<double> normal_s = {};
    std::optional<double> first_s = {}; ///< of the first three layers
    std::uint32_t fade_layers = 10;     ///< in these the first exposure becomes the normal one
    /// When the file is said to be made, in seconds since 1970; as a rule the same always, so that equal
    /// layers give equal bytes.
    std::int64_t created_s = 0;
};

/// The time that builds agree upon, so that results can be compared (reproducible-builds.org): the
/// environment variable SOURCE_DATE_EPOCH, seconds since 1970; 0 where it is not set. Throws Error{usage} for
/// one that is no time.
[[nodiscard]] std::int64_t source_date();

} // namespace lamella
LAMELLA_API_END
