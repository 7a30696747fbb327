#include "slices/images/display.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lamella {

namespace {

constexpr double common_pixel_mm = 0.05;
/// Tolerance in pixels, because published sizes are rounded. The size of a display may deviate by this from
/// an integer number of pixels, and a part may reach this far beyond the last pixel.
constexpr double most_rounding = 0.05;

void check_length(const std::optional<AlongXY<double>>& mm, std::string_view what) {
    if (mm && !(mm->x > 0 && mm->y > 0 && std::isfinite(mm->x) && std::isfinite(mm->y)))
        throw Error(ErrorKind::usage,
                    fmt::format("{} of {} x {} mm: choose positive numbers", what, mm->x, mm->y));
}

struct Side {
    std::uint32_t pixels;
    double pixel_mm;
};

std::uint32_t whole_pixels(double pixels, double part_mm, double pixel_mm) {
    if (!(pixels <= most_pixels))
        throw Error(ErrorKind::usage,
                    fmt::format("{:.6g} mm need {:.6g} pixels of {:.6g} mm, and {} are the most an image may "
                                "have along a side; choose larger pixels",
                                part_mm, pixels, pixel_mm, most_pixels));
    return static_cast<std::uint32_t>(std::max(pixels, 1.0));
}

Side side_of(std::optional<double> pixel_mm, std::optional<std::uint32_t> pixels,
             std::optional<double> display_mm, double part_mm) {
    if (pixels && (*pixels < 1 || *pixels > most_pixels))
        throw Error(ErrorKind::usage, fmt::format("a resolution with {} pixels: each side must have 1 to {}",
                                                  *pixels, most_pixels));
    if (pixels && pixel_mm && display_mm && std::abs(*display_mm / *pixel_mm - *pixels) > most_rounding)
        throw Error(
            ErrorKind::usage,
            fmt::format("{} pixels of {:.6g} mm are {:.6g} mm, not the {:.6g} mm of the display; give "
                        "two of pixel size, resolution and display size",
                        *pixels, *pixel_mm, *pixels * *pixel_mm, *display_mm));
    if (pixels && display_mm)
        return {*pixels, *display_mm / *pixels};
    const double size = pixel_mm.value_or(common_pixel_mm);
    if (pixels)
        return {*pixels, size};
    if (!display_mm)
        return {whole_pixels(std::ceil(part_mm / size - most_rounding), part_mm, size), size};
    const double count = *display_mm / size;
    if (std::abs(count - std::round(count)) > most_rounding)
        throw Error(
            ErrorKind::usage,
            fmt::format("a display of {:.6g} mm has {:.6g} pixels of {:.6g} mm, which is no whole number; "
                        "give the resolution instead of one of them",
                        *display_mm, count, size));
    return {whole_pixels(std::round(count), *display_mm, size), size};
}

template <typename T>
std::optional<T> x_of(const std::optional<AlongXY<T>>& pair) {
    return pair ? std::optional(pair->x) : std::nullopt;
}
template <typename T>
std::optional<T> y_of(const std::optional<AlongXY<T>>& pair) {
    return pair ? std::optional(pair->y) : std::nullopt;
}

/// Throws if a part is higher than the printer can make it. Files in single precision make parts a little
/// higher than they are meant to be.
void check_height(double part_mm, const ResinPrinter& printer) {
    constexpr double slack_mm = 1e-3;
    if (printer.height_mm > 0 && part_mm > printer.height_mm + slack_mm)
        throw Error(
            ErrorKind::usage,
            fmt::format("the part is {:.6g} mm high, and the {} makes parts of up to {:.6g} mm: it is "
                        "{:.4g} mm too high; turn it, make it smaller, or give another printer",
                        part_mm, printer.name, printer.height_mm, part_mm - printer.height_mm));
}

/// Returns the options, completed by values of the printer. Its resolution is used unless the options
/// determine one; its size is used if they have neither a display size nor a pixel size.
ImageOptions with_printer(ImageOptions options, const ResinPrinter& printer) {
    if (printer.name.empty())
        return options;
    if (!options.pixels && !(options.pixel_mm && options.display_mm))
        options.pixels = printer.pixels;
    if (!options.display_mm && !options.pixel_mm)
        options.display_mm = printer.display_mm;
    return options;
}

} // namespace

// Follows PrusaSlicer. Bed coordinates (x, y) begin in a corner of the display. (u, v) is (x, y) in landscape
// and (y, x) in portrait. Mirrored or not, u becomes the column and v the row.
PixelGrid Display::grid(const Box3& box) const noexcept {
    const double x0 = 0.5 * width_mm() - 0.5 * (box.min.x + box.max.x);
    const double y0 = 0.5 * height_mm() - 0.5 * (box.min.y + box.max.y);
    PixelGrid grid{.width = portrait ? pixels.y : pixels.x,
                   .height = portrait ? pixels.x : pixels.y,
                   .ux = 0,
                   .uy = 0,
                   .u0 = 0,
                   .vx = 0,
                   .vy = 0,
                   .v0 = 0};
    const bool turn_u = portrait ? !mirror_x : mirror_x;
    const bool turn_v = !mirror_y;
    const double u_sign = turn_u ? -1 : 1;
    const double v_sign = turn_v ? -1 : 1;
    (portrait ? grid.uy : grid.ux) = u_sign / (portrait ? pixel_mm.y : pixel_mm.x);
    (portrait ? grid.vx : grid.vy) = v_sign / (portrait ? pixel_mm.x : pixel_mm.y);
    grid.u0 = (turn_u ? grid.width : 0) + grid.ux * x0 + grid.uy * y0;
    grid.v0 = (turn_v ? grid.height : 0) + grid.vx * x0 + grid.vy * y0;
    return grid;
}

Display display_for(const Box3& box, const ImageOptions& options, const ResinPrinter& printer) {
    check_length(options.pixel_mm, "a pixel");
    check_length(options.display_mm, "a display");
    const ImageOptions given = with_printer(options, printer);
    const double part_x = box.max.x - box.min.x;
    const double part_y = box.max.y - box.min.y;
    const Side x = side_of(x_of(given.pixel_mm), x_of(given.pixels), x_of(given.display_mm), part_x);
    const Side y = side_of(y_of(given.pixel_mm), y_of(given.pixels), y_of(given.display_mm), part_y);
    const Display display{.pixels = {x.pixels, y.pixels},
                          .pixel_mm = {x.pixel_mm, y.pixel_mm},
                          .portrait = given.portrait.value_or(printer.portrait),
                          .mirror_x = given.mirror_x.value_or(printer.mirror_x),
                          .mirror_y = given.mirror_y.value_or(printer.mirror_y)};
    if (part_x > display.width_mm() + most_rounding * x.pixel_mm ||
        part_y > display.height_mm() + most_rounding * y.pixel_mm)
        throw Error(
            ErrorKind::usage,
            fmt::format("the part measures {:.6g} x {:.6g} mm and the display{}{} only {:.6g} x {:.6g} mm "
                        "({} x {} pixels); turn the part, make it smaller, or give another display",
                        part_x, part_y, printer.name.empty() ? "" : " of the ", printer.name,
                        display.width_mm(), display.height_mm(), x.pixels, y.pixels));
    check_height(box.max.z - box.min.z, printer);
    return display;
}

RasterOptions raster_for(const ImageOptions& options, const ResinPrinter& printer) {
    RasterOptions raster = options.raster;
    if (!printer.grey)
        raster.antialias = 1;
    return raster;
}

} // namespace lamella
