#pragma once

// An image of a whole part, drawn from its layers in a single pass.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"
#include "lamella/raster/image.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Red, green, blue and alpha, one byte each, row after row.
struct ColourImage {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> values;
};

/// Returns an image of the given size with the visible part of `image` in its centre, reduced if necessary,
/// but not enlarged. Each pixel is the mean of the pixels that it covers.
[[nodiscard]] ColourImage fitted(const ColourImage& image, std::uint32_t width, std::uint32_t height);

/// A contribution of a layer to a relief: the columns from `first` to `end` of a row, at the height z.
struct ReliefSpan {
    std::uint32_t row;
    std::uint32_t first;
    std::uint32_t end;
    float z;
};

/// The outside of a part, slightly rotated, seen from the front and above, and lit from the left. Upper
/// layers are drawn over lower ones, each at its own height. In the end the height of each pixel is known,
/// and its neighbours determine the slope. One height is drawn for every two rows of pixels: thin layers are
/// skipped, thick ones are drawn several times. So time is proportional to the number of rows.
class Relief {
  public:
    /// Begins the relief of a part whose bounding box is `box`.
    Relief(const Box3& box, std::uint32_t width, std::uint32_t height);

    /// Returns the visible spans of the layers of all parts at one height. For any number of threads.
    [[nodiscard]] std::vector<ReliefSpan> spans(std::span<const Layer> parts) const;
    /// Adds the spans of a layer, which must be above all layers added before.
    void add(std::span<const ReliefSpan> spans);

    [[nodiscard]] ColourImage image() const;

  private:
    /// A vector in pixels: along the columns, along the ground towards the viewer, and upwards.
    using Vector = std::array<double, 3>;

    /// Draws the layers at the height z, into all rows for which this height is drawn.
    void draw(std::span<const Layer> parts, double z, std::vector<ReliefSpan>& spans) const;
    [[nodiscard]] bool covered(std::size_t row, std::size_t column) const noexcept {
        return row < height_ && column < width_ && !std::isnan(heights_[row * width_ + column]);
    }
    [[nodiscard]] Vector position(std::size_t row, std::size_t column) const noexcept;
    /// Returns the tangent of the surface, down the rows or along the columns.
    [[nodiscard]] Vector tangent(std::size_t row, std::size_t column, bool down) const noexcept;
    /// Returns the brightness of a pixel, from 0 (dark) to 1 (light perpendicular to the surface).
    [[nodiscard]] double light(std::size_t row, std::size_t column) const noexcept;
    /// Returns the brightness of all pixels, smoothed along the surface, because columns and rows form steps,
    /// too.
    [[nodiscard]] std::vector<float> smooth_light() const;

    std::uint32_t width_;
    std::uint32_t height_;
    double lowest_;
    PixelGrid ground_;           ///< position of the plane z = 0 in the image
    double scale_;               ///< pixels per millimetre
    double row_per_z_;           ///< rows by which a millimetre of height moves a pixel upwards
    std::vector<float> heights_; ///< visible heights in mm; NaN where there is nothing
};

} // namespace lamella
