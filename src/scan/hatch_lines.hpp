#pragma once

// Intersections of parallel lines with material: slicing in one dimension less.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"
#include "lamella/core/unit_circle.hpp"

#include "core/layer_budget.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Coordinates along lines (u) and across them (v): the plane rotated back by an angle.
struct LineFrame {
    CosSin angle; ///< of the lines

    [[nodiscard]] double along(const Point2& p) const noexcept { return p.x * angle.cos + p.y * angle.sin; }
    [[nodiscard]] double across(const Point2& p) const noexcept { return p.y * angle.cos - p.x * angle.sin; }
    [[nodiscard]] Point2 point(double u, double v) const noexcept {
        // Avoids -0.
        return {u * angle.cos - v * angle.sin + 0.0, u * angle.sin + v * angle.cos + 0.0};
    }
};

/// The lines through a layer. Line k lies at v = (k + phase) * distance.
class HatchLines {
  public:
    /// `layer` must consist of rings that bound material and do not cross. Throws Error{limit} for more than
    /// 2^22 lines, 2^23 pieces of them, or more than the budget allows, before memory is allocated. Throws
    /// Error{cancelled}, too. O(points + ends), plus sorting the ends of each line.
    HatchLines(const Layer& layer, CosSin angle, double distance, double phase = 0,
               const LayerBudget& budget = {});

    /// Intersects the lines with other lines, or subtracts other lines from them. The other lines must have
    /// the same angle, distance and phase. O(lines + ends).
    void intersect(const HatchLines& others, const LayerBudget& budget = {});
    void subtract(const HatchLines& others, const LayerBudget& budget = {});

    [[nodiscard]] const LineFrame& frame() const noexcept { return frame_; }
    [[nodiscard]] std::size_t size() const noexcept { return begins_.size() - 1; }
    /// Returns the k of line 0.
    [[nodiscard]] std::int64_t first() const noexcept { return first_; }
    /// Returns the v of line i, counted from 0.
    [[nodiscard]] double v(std::size_t i) const noexcept {
        return (static_cast<double>(first_ + static_cast<std::int64_t>(i)) + phase_) * distance_;
    }
    /// Returns whether the k of line i is odd.
    [[nodiscard]] bool odd(std::size_t i) const noexcept {
        return ((first_ + static_cast<std::int64_t>(i)) & 1) != 0;
    }
    /// Returns the u at which material begins and ends along the line, alternating, in ascending order.
    [[nodiscard]] std::span<const double> ends(std::size_t i) const noexcept {
        return std::span(ends_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
    }
    /// Returns the number of ends on all lines.
    [[nodiscard]] std::size_t total() const noexcept { return ends_.size(); }
    /// Returns the memory in use.
    [[nodiscard]] std::uint64_t bytes() const noexcept {
        return begins_.size() * sizeof begins_.front() + ends_.size() * sizeof ends_.front();
    }

  private:
    template <bool inside>
    void keep(const HatchLines& others, const LayerBudget& budget);

    LineFrame frame_;
    double distance_;
    double phase_;
    std::int64_t first_ = 0;
    std::vector<std::uint32_t> begins_{0}; ///< index of the first end of each line, then the number of ends
    std::vector<double> ends_;
};

} // namespace lamella
