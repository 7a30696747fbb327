#pragma once

// A picture of a whole part, drawn from its layers while they pass by.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"
#include "lamella/raster/picture.hpp"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Red, green, blue and alpha, a byte each, row after row.
struct ColourPicture {
    std::uint32_t width = 0;
    std::uint32_t height = 0;
    std::vector<std::uint8_t> values;
};

/// What of a picture is not transparent, in the middle of other sides and no larger than it was. A pixel is
/// the mean of those that it covers.
[[nodiscard]] ColourPicture fitted(const ColourPicture& picture, std::uint32_t width, std::uint32_t height);

/// What a layer adds to a relief: in a row, the columns from `first` to `end`, at the height z.
struct ReliefSpan {
    std::uint32_t row;
    std::uint32_t first;
    std::uint32_t end;
    float z;
};

/// The outside of a part as one sees it from above and in front, turned a little, lit from the left. Upper
/// layers are drawn over lower ones, each where it lies at its own height; so of each pixel it is known in
/// the end how high it lies, and neighbours tell how steep it is there. For each two
/// rows of pixels one height is drawn: thin layers are left out, thick ones drawn several times, and the time
/// goes with the rows.
class Relief {
  public:
    /// Of a part within this box.
    Relief(const Box3& box, std::uint32_t width, std::uint32_t height);

    /// Where the layers of all parts at one height are seen. For any number of threads.
    [[nodiscard]] std::vector<ReliefSpan> spans(std::span<const Layer> parts) const;
    /// Puts a layer upon the lower ones.
    void add(std::span<const ReliefSpan> spans);

    [[nodiscard]] ColourPicture picture() const;

  private:
    /// Along the columns, on the ground towards the viewer, and upwards; all in pixels.
    using Vector = std::array<double, 3>;

    /// What is seen of a height, and of the rows that are drawn with it.
    void draw(std::span<const Layer> parts, double z, std::vector<ReliefSpan>& spans) const;
    [[nodiscard]] bool covered(std::size_t row, std::size_t column) const noexcept {
        return row < height_ && column < width_ && !std::isnan(heights_[row * width_ + column]);
    }
    [[nodiscard]] Vector place(std::size_t row, std::size_t column) const noexcept;
    /// The direction in which the surface runs down the rows, or else along the columns.
    [[nodiscard]] Vector tangent(std::size_t row, std::size_t column, bool down) const noexcept;
    /// 0 where it is dark to 1 where the light falls straight down.
    [[nodiscard]] double light(std::size_t row, std::size_t column) const noexcept;
    /// Of all pixels, smoothed along the surface: columns and rows are steps, too.
    [[nodiscard]] std::vector<float> smooth_light() const;

    std::uint32_t width_;
    std::uint32_t height_;
    double lowest_;
    PixelGrid ground_;           ///< where the plane z = 0 is seen
    double scale_;               ///< pixels per millimetre
    double row_per_z_;           ///< rows upwards per millimetre
    std::vector<float> heights_; ///< of what is seen, mm; not a number where there is nothing
};

} // namespace lamella
