#pragma once

// Layers as pixels, for projectors and displays such as those of resin printers.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/run_image.hpp"

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Largest width and height of an image in pixels, and largest number of anti-aliasing levels.
inline constexpr std::uint32_t most_pixels = 65535;
inline constexpr unsigned most_antialias = 64;

/// The grey value of pixels of which this part is covered.
struct GreyPoint {
    double covered = 0; ///< from 0 to 1
    double value = 0;   ///< from 0 to 255

    friend bool operator==(const GreyPoint&, const GreyPoint&) = default;
};

/// The value of a pixel by its coverage, in steps of 1/255.
using GreyValues = std::array<std::uint8_t, 256>;

/// Returns the values on a curve through these points, whose covered parts must ascend. Values between two
/// points are interpolated. Unless there are other points at these parts, the curve begins at 0:0 and ends at
/// 1:255. Pixels without material always have the value 0, so a first point of 0:60 makes 60 the darkest
/// grey. Throws Error{usage} for impossible points, and if 1 does not get the value 255.
[[nodiscard]] GreyValues grey_curve(std::span<const GreyPoint> points);

struct RasterOptions {
    /// Number of strips into which a row of pixels is divided where exact coverage would take too long. A
    /// pixel's coverage is the fraction of its area in which the winding number is not zero. Coverage is
    /// exact, with one exception: a contiguous part of a row that contains more corners and crossings of
    /// contours than this number, or more than twice as many edges, and is not a single line with bends. In
    /// such a part each strip is evaluated along its middle line. The error of a strip is less than its area,
    /// and is 0 unless contours begin, end, bend or cross within the strip.
    ///
    /// 1 disables anti-aliasing: a pixel is covered if its centre is. A centre exactly on a contour counts as
    /// covered if the material lies to its right or, on a horizontal edge, below it, so that adjacent bodies
    /// share no pixel.
    unsigned antialias = 8;
    /// Set if the winding number is known to be 0 or 1 everywhere (see `winds_once`). Then coverage is
    /// computed as a sum over the edges in any order: exact, and several times as fast if contours are finer
    /// than pixels. If this is set although contours overlap, overlaps within a pixel count several times, up
    /// to the whole pixel. Without anti-aliasing, it has no effect. Image writers set it themselves.
    bool winds_once = false;
    /// The value of a pixel is 255 (v / 255)^gamma, rounded, where v is 255 times its coverage, rounded.
    double gamma = 1;
    /// If set, the value of a pixel is grey_values[v] instead, and `gamma` must be 1. The first value must be
    /// 0, for pixels without material, and the last one 255.
    std::optional<GreyValues> grey_values = {};
};

/// Consecutive pixels of a row with the same value, from the end of the previous run up to `end`.
struct PixelRun {
    std::uint32_t end = 0;
    std::uint8_t value = 0;

    friend bool operator==(const PixelRun&, const PixelRun&) = default;
};

/// Receives the rows of an image from the top down, `times` equal rows per call. Consecutive runs differ in
/// value; the last one ends at the width of the image.
using RowSink = std::function<void(std::span<const PixelRun> row, std::uint32_t times)>;

/// Areas of an image, in pixels.
struct RasterAreas {
    double covered = 0; ///< before coverage is rounded to values
    /// Material that no pixel shows. With anti-aliasing: the coverage of pixels whose value is 0. Without:
    /// bodies, and thin parts of bodies, that lie between the lines through the centres of pixels, or between
    /// the centres of at least two consecutive rows. Area that the edges of larger bodies lose by rounding to
    /// whole pixels does not count.
    double unseen = 0;
};

/// Rasterises the closed rings of all parts at one height, row by row. Area covered by several parts counts
/// once. Open chains are ignored; everything outside the image is clipped. Throws Error{usage} for a grid or
/// options that define no image.
///
/// O(p + c log c + r) for p points, r rows and c crossings of contours with rows (or with strips of rows),
/// with memory for the points and one row. With `winds_once` O(p + c + r), with memory for a few rows.
RasterAreas rasterise(std::span<const Layer> parts, const PixelGrid& grid, const RasterOptions& options,
                      const RowSink& sink);

/// An image in memory, row after row.
struct GreyImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> values;

    [[nodiscard]] std::span<const std::uint8_t> row(std::uint32_t r) const noexcept {
        return std::span(values).subspan(std::size_t{r} * width, width);
    }
};

/// Rasterises parts like `rasterise`, and returns the whole image.
[[nodiscard]] GreyImage paint(std::span<const Layer> parts, const PixelGrid& grid,
                              const RasterOptions& options = {});

} // namespace lamella
LAMELLA_API_END
