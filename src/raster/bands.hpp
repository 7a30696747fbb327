#pragma once

// The edges of contours by the rows of a picture that they reach.

#include "lamella/contour/layer.hpp"

#include "raster/edges.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// A picture from the top down in bands of a few rows, and the edges that reach into each. Contours are not
/// copied but for the places where they enter and leave a band.
class Bands {
  public:
    /// The parts are to outlive the bands. O(points).
    Bands(std::span<const Layer> parts, const PixelGrid& grid);

    /// Of a band, all of them but the last, which may have fewer.
    [[nodiscard]] std::uint32_t rows() const noexcept { return rows_; }

    /// Calls line(points) for stretches of rings as they lie in the picture: all edges that reach into the
    /// band are in one of them. Others may be, too, but these reach from one band into the next as well, or
    /// are level.
    template <class Line>
    void for_each_line(std::uint32_t band, const Line& line) const {
        std::array<Point2, 256> places;
        for (std::size_t i = starts_[band]; i < starts_[band + 1]; ++i) {
            const Stretch& stretch = stretches_[i];
            place_in_picture({stretch.before, 1}, grid_, places.data());
            for (std::size_t done = 0; done < stretch.edges;) {
                const std::size_t n = std::min(places.size() - 1, stretch.edges - done);
                place_in_picture({stretch.first + done, n}, grid_, places.data() + 1);
                line(std::span<const Point2>(places.data(), n + 1));
                places.front() = places[n];
                done += n;
            }
        }
    }

  private:
    /// Edges that follow one another in a ring.
    struct Stretch {
        const Point2* before; ///< where the first of them begins
        const Point2* first;  ///< where it ends; the others end at the points after it
        std::size_t edges;
        std::size_t band;
    };

    void cut(std::span<const Point2> ring, std::vector<std::int32_t>& band_of, std::vector<Stretch>& found);

    PixelGrid grid_;
    std::uint32_t rows_;
    std::int32_t count_;
    std::vector<Stretch> stretches_;  ///< by bands
    std::vector<std::size_t> starts_; ///< of each band, and the end
};

} // namespace lamella
