#pragma once

// The edges of contours, sorted by the rows of an image that they reach.

#include "lamella/contour/layer.hpp"

#include "raster/edges.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// An image divided into bands of a few rows, from the top down, with the edges that reach into each band.
/// Contours are not copied. Only references to the points where they enter and leave a band are stored.
class Bands {
  public:
    /// The parts must outlive the bands. O(points).
    Bands(std::span<const Layer> parts, const PixelGrid& grid);

    /// Returns the number of rows of a band; the last band may have fewer.
    [[nodiscard]] std::uint32_t rows() const noexcept { return rows_; }

    /// Calls line(points) for parts of rings, in image coordinates. Together they contain each edge that
    /// reaches into the band once. The only other edges in them are horizontal, or reach from one band into
    /// the next.
    template <class Line>
    void for_each_line(std::uint32_t band, const Line& line) const {
        assert(band + 1 < starts_.size());
        std::array<Point2, 256> positions;
        for (std::size_t i = starts_[band]; i < starts_[band + 1]; ++i) {
            const PixelSpan& span = spans_[i];
            position_in_image({span.before, 1}, grid_, positions.data());
            for (std::size_t done = 0; done < span.edges;) {
                const std::size_t n = std::min(positions.size() - 1, span.edges - done);
                position_in_image({span.first + done, n}, grid_, positions.data() + 1);
                line(std::span<const Point2>(positions.data(), n + 1));
                positions.front() = positions[n];
                done += n;
            }
        }
    }

  private:
    /// Consecutive edges of a ring.
    struct PixelSpan {
        const Point2* before; ///< start of the first edge
        const Point2* first;  ///< end of the first edge; the others end at the points after it
        std::size_t edges;
        std::size_t band;
    };

    void cut(std::span<const Point2> ring, std::vector<std::int32_t>& band_of, std::vector<PixelSpan>& found);

    PixelGrid grid_;
    std::uint32_t rows_;
    std::int32_t count_;
    std::vector<PixelSpan> spans_;    ///< ordered by band
    std::vector<std::size_t> starts_; ///< index of the first span of each band, and the number of spans
};

} // namespace lamella
