#pragma once

// The pixels of a display or picture, and where the part lies among them.

#include "lamella/raster/picture.hpp"
#include "lamella/write/layer_writer.hpp"
#include "lamella/write/picture_options.hpp"

#include <cstdint>
#include <string_view>

namespace lamella {

/// What is known of a printer that shows pictures.
struct PicturePrinter {
    std::string_view name = {}; ///< as people and its files call it; "" for none
    AlongXY<std::uint32_t> pixels{};
    AlongXY<double> display_mm{};
    bool portrait = false;
    bool mirror_x = false;
    bool mirror_y = false;
    double normal_s = 0;
    double first_s = 0;
    /// For a layer that covers at most so much of the display, and for others, the time between exposures.
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

    /// The picture, with the middle of the box in the middle of the display.
    [[nodiscard]] PixelGrid grid(const Box3& box) const noexcept;
};

/// The display that options ask for, on this printer. Throws Error{usage} where they contradict themselves
/// and where the part, which has this box, does not fit; says by how much.
[[nodiscard]] Display display_for(const Box3& box, const PictureOptions& options,
                                  const PicturePrinter& printer);

} // namespace lamella
