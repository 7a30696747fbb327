#pragma once

// Pixel grid of a display or image, and the position of the part on it.

#include "lamella/raster/image.hpp"
#include "lamella/slices/image_options.hpp"
#include "lamella/slices/layer_writer.hpp"

#include <cstdint>
#include <string_view>

namespace lamella {

/// Properties of a printer that displays images.
struct ImagePrinter {
    std::string_view name = {}; ///< name in help and in files; "" for no printer
    AlongXY<std::uint32_t> pixels{};
    AlongXY<double> display_mm{};
    bool portrait = false;
    bool mirror_x = false;
    bool mirror_y = false;
    double normal_s = 0;
    double first_s = 0;
    /// A layer is large if it covers more than this fraction of the display. The pauses are the times without
    /// exposure for small and for large layers.
    double large_area = 0.5;
    double small_pause_s = 0;
    double large_pause_s = 0;
};

struct Display {
    AlongXY<std::uint32_t> pixels;
    AlongXY<double> pixel_mm;
    bool portrait;
    bool mirror_x;
    bool mirror_y;

    [[nodiscard]] double width_mm() const noexcept { return pixels.x * pixel_mm.x; }
    [[nodiscard]] double height_mm() const noexcept { return pixels.y * pixel_mm.y; }
    [[nodiscard]] double pixel_mm2() const noexcept { return pixel_mm.x * pixel_mm.y; }

    /// Returns the pixel grid with the middle of the box in the middle of the display.
    [[nodiscard]] PixelGrid grid(const Box3& box) const noexcept;
};

/// Returns the display that the options describe, on this printer. Throws Error{usage} if they contradict
/// each other, or if a part with this box does not fit; the error then states by how much.
[[nodiscard]] Display display_for(const Box3& box, const ImageOptions& options, const ImagePrinter& printer);

} // namespace lamella
