#pragma once

// Options for images of layers.

#include "lamella/raster/image.hpp"

#include <cstdint>
#include <optional>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// A pair of values, along x and along y of the layers.
template <typename T>
struct AlongXY {
    T x;
    T y;
};

/// The colour of a part.
struct PartColour {
    std::uint8_t red = 0;
    std::uint8_t green = 0;
    std::uint8_t blue = 0;

    friend bool operator==(const PartColour&, const PartColour&) = default;
};

/// Options of all formats with images: the pixels of the image, and how they map to the part.
/// The centre of the part's box is at the centre of the display.
struct ImageOptions {
    /// Size of a pixel, number of pixels, and size of the display. Two of them determine the third. The
    /// defaults are the values of the printer. Without a printer, pixels are 0.05 mm wide, and
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

    /// If true, images of png and png-zip have a palette: each pixel has the colour of the part in which its
    /// centre lies, and is transparent outside of all. Of several parts it is the one that covers most of the
    /// pixel, and the first among equals. `raster` does not apply.
    bool colour_parts = false;
    /// The colour of each part; if there are none, colours are chosen. Black is the background.
    std::vector<PartColour> part_colours{};
};

} // namespace lamella
LAMELLA_API_END
