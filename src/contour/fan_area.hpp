#pragma once

// Computes the area of a ring in a loop that visits its points for another purpose.

#include "lamella/core/point.hpp"

#include "core/vectors.hpp"

#include <array>
#include <cassert>
#include <cstddef>
#include <span>

namespace lamella {

/// Sums up the triangles of a fan about the first point of a ring, four at a time. The four sums are added in
/// a fixed order at the end: with a single sum, each addition would wait for the previous one.
class FanArea {
  public:
    /// The first point that forms a triangle with the one before it.
    static constexpr std::size_t first = 2;

    [[gnu::always_inline]] explicit FanArea(const Point2& origin)
        : origin_{origin.x, origin.y, origin.x, origin.y} {}

    /// Adds the triangles of points i to i + 3, each with the point before it; i is `first` + 4 k.
    [[gnu::always_inline]] void add_four(std::span<const Point2> ring, std::size_t i) {
        assert(i >= first && i + 4 <= ring.size());
        const Four a01 = at<4>(&ring[i - 1].x).v - origin_;
        const Four a23 = at<4>(&ring[i + 1].x).v - origin_;
        const Four b01 = at<4>(&ring[i].x).v - origin_;
        const Four b23 = at<4>(&ring[i + 2].x).v - origin_;
        const Four ax = __builtin_shufflevector(a01, a23, 0, 4, 2, 6);
        const Four ay = __builtin_shufflevector(a01, a23, 1, 5, 3, 7);
        const Four bx = __builtin_shufflevector(b01, b23, 0, 4, 2, 6);
        const Four by = __builtin_shufflevector(b01, b23, 1, 5, 3, 7);
        sums_ += ax * by - ay * bx;
    }

    /// Returns the area, including the remaining triangles from point i on, fewer than four.
    [[gnu::always_inline]] [[nodiscard]] double end(std::span<const Point2> ring, std::size_t i) const {
        assert(ring.size() < i + 4);
        std::array<double, 4> sums{sums_[0], sums_[2], sums_[1], sums_[3]};
        for (std::size_t k = 0; k < 3; ++k) {
            if (i + k >= ring.size())
                break;
            const double ax = ring[i + k - 1].x - origin_[0];
            const double ay = ring[i + k - 1].y - origin_[1];
            const double bx = ring[i + k].x - origin_[0];
            const double by = ring[i + k].y - origin_[1];
            sums[k] += ax * by - ay * bx;
        }
        return 0.5 * ((sums[0] + sums[1]) + (sums[2] + sums[3]));
    }

  private:
    using Four = Vector<4>::Doubles;

    Four origin_;
    Four sums_{}; ///< sums for the first, third, second and fourth of every four points
};

} // namespace lamella
