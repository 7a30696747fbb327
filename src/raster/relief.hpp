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

/// Returns the visible part of an image, centred in an image of another size and not enlarged. A pixel is the
/// mean of those that it covers.
[[nodiscard]] ColourImage fitted(const ColourImage& image, std::uint32_t width, std::uint32_t height);

/// A contribution of a layer to a relief: the columns from `first` to `end` of a row, at the height z.
struct ReliefSpan {
    std::uint32_t row;
    std::uint32_t first;
    std::uint32_t end;
    float z;
};

/// The outside of a part seen from above and in front, slightly rotated, lit from the left. Upper layers are
/// drawn over lower ones, each at its own height. So in the end the height of each pixel is known, and
/// neighbours determine the slope. One height is drawn for each two rows of pixels: thin layers are skipped,
/// thick ones drawn several times, so time is proportional to the number of rows.
class Relief {
  public:
    /// A relief of a part within this box.
    Relief(const Box3& box, std::uint32_t width, std::uint32_t height);

    /// Returns the visible spans of the layers of all parts at one height. For any number of threads.
    [[nodiscard]] std::vector<ReliefSpan> spans(std::span<const Layer> parts) const;
    /// Adds a layer above the lower ones.
    void add(std::span<const ReliefSpan> spans);

    [[nodiscard]] ColourImage image() const;

  private:
    /// Along the columns, along the ground towards the viewer, and upwards; all in pixels.
    using Vector = std::array<double, 3>;

    /// Draws one height, and the rows that are drawn with it.
    void draw(std::span<const Layer> parts, double z, std::vector<ReliefSpan>& spans) const;
    [[nodiscard]] bool covered(std::size_t row, std::size_t column) const noexcept {
        return row < height_ && column < width_ && !std::isnan(heights_[row * width_ + column]);
    }
    [[nodiscard]] Vector position(std::size_t row, std::size_t column) const noexcept;
    /// Returns the direction of the surface down the rows, or along the columns.
    [[nodiscard]] Vector tangent(std::size_t row, std::size_t column, bool down) const noexcept;
    /// Returns the light from 0 (dark) to 1 (perpendicular).
    [[nodiscard]] double light(std::size_t row, std::size_t column) const noexcept;
    /// Returns the light of all pixels, smoothed along the surface: columns and rows are steps, too.
    [[nodiscard]] std::vector<float> smooth_light() const;

    std::uint32_t width_;
    std::uint32_t height_;
    double lowest_;
    PixelGrid ground_;           ///< position of the plane z = 0 in the image
    double scale_;               ///< pixels per millimetre
    double row_per_z_;           ///< rows upwards per millimetre
    std::vector<float> heights_; ///< visible heights in mm; NaN where there is nothing
};

} // namespace lamella
