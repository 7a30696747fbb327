#pragma once

// Layers as pixels: for projectors and displays, as resin printers have them.

#include "lamella/contour/layer.hpp"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The pixels of a picture and where a layer lies among them. Pixel (c, r) is the square [c, c + 1] x [r, r +
/// 1] of picture coordinates (u, v): columns to the right, rows downwards. The point (x, y) lies at
///     u = ux x + uy y + u0,    v = vx x + vy y + v0.
struct PixelGrid {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    double ux = 1, uy = 0, u0 = 0;
    double vx = 0, vy = 1, v0 = 0;
};

/// Pixels along each side of a picture, and levels of anti-aliasing.
inline constexpr std::uint32_t most_pixels = 65535;
inline constexpr unsigned most_antialias = 64;

struct RasterOptions {
    /// A pixel's coverage is the part of its area where the winding number is not zero. It is exact, except
    /// in a stretch of a row where more corners and crossings of contours than this number, or twice as many
    /// edges, lie side by side without a gap and are not just one line with its bends. There the row is cut
    /// into this number of strips; each is decided in its middle, and wrong by less than its share where
    /// contours begin, end, bend or cross within it.
    ///
    /// 1 is no anti-aliasing: a pixel is covered, or not, as its centre is. A centre on a contour counts when
    /// the material lies to its right or, on a level line, below it: bodies side by side share no pixel.
    unsigned antialias = 8;
    /// The caller knows that the winding number is 0 or 1 everywhere, as polygon's `winds_once` tells: then
    /// coverage is a sum over the edges in any order, exact, and several times as fast where contours are
    /// finer than pixels. Where it is not so, what is covered several times in one pixel counts as often, up
    /// to the whole pixel. Makes no difference without anti-aliasing. Writers of pictures find it out by
    /// themselves.
    bool winds_once = false;
    /// A pixel's value is 255 (v / 255)^gamma, rounded, where v is 255 times its coverage, rounded.
    double gamma = 1;
};

/// Pixels of a row up to `end`, from where the run before ended, all of one value.
struct PixelRun {
    std::uint32_t end = 0;
    std::uint8_t value = 0;

    friend bool operator==(const PixelRun&, const PixelRun&) = default;
};

/// Takes the next rows of a picture, from the top down: `times` rows that are all the same. Runs that follow
/// one another differ in value; the last one ends at the width of the picture.
using RowSink = std::function<void(std::span<const PixelRun> row, std::uint32_t times)>;

/// The picture of the closed rings of all parts at one height, row by row: what any of them covers is
/// covered once. Open chains have no area and leave no trace; what lies beyond the picture is cut off.
/// Returns the covered area in pixels, before it was rounded to values.
///
/// O(p + c log c + r) for p points, r rows and c crossings of contours with rows (with strips, where rows are
/// cut into them), in memory for the points and one row; with `winds_once` O(p + c + r), in memory for a few
/// rows. Throws Error{usage} for a grid or options that make
/// no picture.
double rasterise(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options,
                 const RowSink& sink);

/// A picture in memory, row after row.
struct GreyPicture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> values;

    [[nodiscard]] std::span<const std::uint8_t> row(std::uint32_t r) const noexcept {
        return std::span(values).subspan(std::size_t{r} * width, width);
    }
};

/// The same, collected.
[[nodiscard]] GreyPicture paint(std::span<const Layer> parts, const PixelGrid& grid,
                                const RasterOptions& options = {});

} // namespace lamella
LAMELLA_API_END
