#pragma once

// Pixel grid of a display or image, and the position of the part on it.

#include "lamella/raster/image.hpp"
#include "lamella/slices/image_options.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slices/resin_printer.hpp"

#include <cstdint>

namespace lamella {

struct Display {
    AlongXY<std::uint32_t> pixels;
    AlongXY<double> pixel_mm;
    bool portrait;
    bool mirror_x;
    bool mirror_y;

    [[nodiscard]] double width_mm() const noexcept { return pixels.x * pixel_mm.x; }
    [[nodiscard]] double height_mm() const noexcept { return pixels.y * pixel_mm.y; }
    /// Returns the size along the columns and along the rows of an image.
    [[nodiscard]] AlongXY<double> image_mm() const noexcept {
        return portrait ? AlongXY<double>{height_mm(), width_mm()} : AlongXY<double>{width_mm(), height_mm()};
    }
    [[nodiscard]] double pixel_mm2() const noexcept { return pixel_mm.x * pixel_mm.y; }

    /// Returns the pixel grid with the middle of the box in the middle of the display.
    [[nodiscard]] PixelGrid grid(const Box3& box) const noexcept;
};

/// Returns the display that the options describe, on this printer. Throws Error{usage} if they contradict
/// each other, or if a part with this box does not fit, also in its height; the error then states by how
/// much.
[[nodiscard]] Display display_for(const Box3& box, const ImageOptions& options, const ResinPrinter& printer);

/// A display and the pixel grid of images for it.
struct DisplayGrid {
    Display display;
    PixelGrid grid;
};

/// Returns the display that images with this grid were made for.
[[nodiscard]] Display display_of(const PixelGrid& grid) noexcept;

/// Returns the display that the options describe, on this printer, for the layers of this file. If these have
/// images, what neither describes is that of the images. Throws as `display_for` does, and Error{usage},
/// which names both, if the images have other pixels than the display.
[[nodiscard]] DisplayGrid display_grid(const LayerFileInfo& info, const ImageOptions& options,
                                       const ResinPrinter& printer);

/// Returns the options of images for this printer: without grey if its display shows none.
[[nodiscard]] RasterOptions raster_for(const ImageOptions& options, const ResinPrinter& printer);

} // namespace lamella
