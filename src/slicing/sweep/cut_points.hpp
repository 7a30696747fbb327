#pragma once

// The points of one contour on one plane, and the point where the contour starts in normal form
// (lamella/contour/normal_form.hpp).

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/point.hpp"

#include "core/orientation.hpp"
#include "core/pages.hpp"
#include "slicing/shrunken_contours.hpp"
#include "slicing/sweep/point_kernels.hpp"

#include <cassert>
#include <cstddef>
#include <vector>

namespace lamella {

/// The start of a ring in normal form.
struct RingStart {
    std::size_t index;
    bool alone; ///< true if no other x is within the tolerance of the least x
    bool flat;  ///< true if the ring is a line
};

/// Points in walk order, in memory that is reused for each contour.
class CutPoints {
  public:
    /// Replaces the points by the cuts of a contour's edges with the plane z.
    CutSurvey compute(const EdgeColumns& edges, double z) {
        const std::size_t room = EdgeColumns::padded(edges.size);
        if (x_.size() < room) {
            x_ = PageArray<double>(room + room / 2);
            y_ = PageArray<double>(room + room / 2);
        }
        size_ = edges.size;
        return kernels_.survey(edges, z, x_.data(), y_.data());
    }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    [[nodiscard]] Point2 operator[](std::size_t i) const noexcept {
        assert(i < size_);
        return {x_[i], y_[i]};
    }

    /// Returns the square of the distance between the first and the last point.
    [[nodiscard]] double squared_closing() const noexcept {
        const double dx = x_[0] - x_[size_ - 1];
        const double dy = y_[0] - y_[size_ - 1];
        return dx * dx + dy * dy;
    }

    /// Drops points that equal their predecessor.
    void drop_repeats(bool closed) noexcept {
        assert(size_ > 0);
        std::size_t kept = 1;
        for (std::size_t i = 1; i < size_; ++i) {
            if (x_[i] == x_[kept - 1] && y_[i] == y_[kept - 1])
                continue;
            x_[kept] = x_[i];
            y_[kept] = y_[i];
            ++kept;
        }
        while (closed && kept > 1 && x_[kept - 1] == x_[0] && y_[kept - 1] == y_[0])
            --kept;
        size_ = kept;
    }

    /// Returns the start of a ring. Requires three points or more, none equal to its predecessor, and `least`
    /// as their least x. `had_repeats` states that repeated points were dropped; the ring may then be a line
    /// even if it does not fold at its start.
    [[nodiscard]] RingStart start(double least, double tolerance, bool had_repeats) const {
        assert(size_ >= 3);
        const auto next_within = [&](std::size_t from, double value) {
            return kernels_.find_not_above(x_.data(), from, size_, value);
        };
        std::size_t start = next_within(0, least + tolerance);
        assert(start < size_);
        const bool alone = next_within(start + 1, least + tolerance) == size_;
        bool tie = false;
        if (!alone) {
            start = next_within(start, least);
            assert(start < size_ && x_[start] == least);
            for (std::size_t i = next_within(start + 1, least); i < size_; i = next_within(i + 1, least)) {
                if (y_[i] < y_[start]) {
                    start = i;
                    tie = false;
                } else if (y_[i] == y_[start]) {
                    tie = true;
                }
            }
        }
        const CutPoints& points = *this;
        const std::size_t before = start == 0 ? size_ - 1 : start - 1;
        const std::size_t after = start + 1 == size_ ? 0 : start + 1;
        // A ring turns at its smallest point, unless it folds back there.
        const bool fold = orientation(points[before], points[start], points[after]) == 0;
        if (had_repeats || tie || fold) {
            std::vector<Point2> ring(size_);
            for (std::size_t i = 0; i < size_; ++i)
                ring[i] = points[i];
            if (folds_flat(ring) || lies_on_line(ring))
                return {start, alone, true};
            if (tie)
                start = smallest_rotation(ring);
        }
        return {start, alone, false};
    }

  private:
    const PointKernels& kernels_ = point_kernels();
    std::size_t size_ = 0;
    PageArray<double> x_;
    PageArray<double> y_;
};

} // namespace lamella
