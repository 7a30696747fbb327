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

namespace {

/// Returns the grid of an image that is mirrored along its columns or rows.
PixelGrid mirrored(PixelGrid grid, bool columns, bool rows) noexcept {
    if (columns) {
        grid.ux = 0.0 - grid.ux;
        grid.uy = 0.0 - grid.uy;
        grid.u0 = grid.width - grid.u0;
    }
    if (rows) {
        grid.vx = 0.0 - grid.vx;
        grid.vy = 0.0 - grid.vy;
        grid.v0 = grid.height - grid.v0;
    }
    return grid;
}

/// Throws unless images with the pixels of `has` fit the display `wanted`.
void check_pixels(const Display& has, const Display& wanted, const std::string& made_for,
                  const ResinPrinter& printer) {
    const auto name = [](std::string_view printer_name, std::string_view other) {
        return printer_name.empty() ? std::string(other) : std::string(printer_name);
    };
    const std::string file =
        made_for.empty() ? "the images of the file" : fmt::format("the images of the file ({})", made_for);
    const std::string display = name(printer.name, "the display");
    if (has.pixels.x != wanted.pixels.x || has.pixels.y != wanted.pixels.y || has.portrait != wanted.portrait)
        throw Error(
            ErrorKind::usage,
            fmt::format("{} have {} x {} pixels{}, and {} has {} x {}{}; pixels are kept as they are, so "
                        "give a printer with the same, or slice the mesh for this one",
                        file, has.pixels.x, has.pixels.y, has.portrait ? " (portrait)" : "", display,
                        wanted.pixels.x, wanted.pixels.y, wanted.portrait ? " (portrait)" : ""));
    constexpr double most = 0.01; // sizes are rounded in files and lists
    if (std::abs(has.pixel_mm.x / wanted.pixel_mm.x - 1) > most ||
        std::abs(has.pixel_mm.y / wanted.pixel_mm.y - 1) > most)
        throw Error(ErrorKind::usage,
                    fmt::format("{} have pixels of {:.4g} x {:.4g} mm, and {} has pixels of {:.4g} x {:.4g} "
                                "mm: the part would get another size; slice the mesh for this display",
                                file, has.pixel_mm.x, has.pixel_mm.y, display, wanted.pixel_mm.x,
                                wanted.pixel_mm.y));
}

/// Returns the options, completed by the display of the images where neither they nor the printer say
/// anything.
ImageOptions with_images(ImageOptions options, const Display& images, const ResinPrinter& printer) {
    if (!printer.name.empty())
        return options;
    if (!options.pixels && !(options.pixel_mm && options.display_mm))
        options.pixels = images.pixels;
    if (!options.pixel_mm && !options.display_mm)
        options.pixel_mm = images.pixel_mm;
    if (!options.portrait)
        options.portrait = images.portrait;
    if (!options.mirror_x)
        options.mirror_x = images.mirror_x;
    if (!options.mirror_y)
        options.mirror_y = images.mirror_y;
    return options;
}

} // namespace

// The inverse of Display::grid.
Display display_of(const PixelGrid& grid) noexcept {
    const bool portrait = grid.ux == 0;
    const double u = portrait ? grid.uy : grid.ux;
    const double v = portrait ? grid.vx : grid.vy;
    const double pixel_u = 1 / std::abs(u);
    const double pixel_v = 1 / std::abs(v);
    Display display{.pixels = {grid.width, grid.height},
                    .pixel_mm = {pixel_u, pixel_v},
                    .portrait = portrait,
                    .mirror_x = (u < 0) != portrait,
                    .mirror_y = v > 0};
    if (portrait) {
        std::swap(display.pixels.x, display.pixels.y);
        std::swap(display.pixel_mm.x, display.pixel_mm.y);
    }
    return display;
}

DisplayGrid display_grid(const LayerFileInfo& info, const ImageOptions& options,
                         const ResinPrinter& printer) {
    if (!info.grid) {
        const Display display = display_for(info.box, options, printer);
        return {display, display.grid(info.box)};
    }
    const Display images = display_of(*info.grid);
    Box3 flat; // the part is where it is, so only its height must fit
    flat.add(Point3{0, 0, info.box.min.z});
    flat.add(Point3{0, 0, info.box.max.z});
    const Display display = display_for(flat, with_images(options, images, printer), printer);
    check_pixels(images, display, info.printer, printer);
    const bool turn = display.mirror_x != images.mirror_x;
    return {display, mirrored(*info.grid, turn, display.mirror_y != images.mirror_y)};
}

RasterOptions raster_for(const ImageOptions& options, const ResinPrinter& printer) {
    RasterOptions raster = options.raster;
    if (!printer.grey)
        raster.antialias = 1;
    return raster;
}

} // namespace lamella
