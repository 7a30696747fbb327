#pragma once

// Where parallel lines run through material: slicing in one dimension less.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"
#include "lamella/core/unit_circle.hpp"

#include "core/layer_budget.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// Coordinates along lines (u) and across them (v): the plane turned back by an angle.
struct LineFrame {
    CosSin angle; ///< of the lines

    [[nodiscard]] double along(const Point2& p) const noexcept { return p.x * angle.cos + p.y * angle.sin; }
    [[nodiscard]] double across(const Point2& p) const noexcept { return p.y * angle.cos - p.x * angle.sin; }
    [[nodiscard]] Point2 point(double u, double v) const noexcept {
        // No -0.
        return {u * angle.cos - v * angle.sin + 0.0, u * angle.sin + v * angle.cos + 0.0};
    }
};

/// The lines that run through a layer. Line k of all lies at v = (k + phase) * distance.
class HatchLines {
  public:
    /// `layer`: rings that bound material, none of which cross. Throws Error{limit} for more than 2^22 lines,
    /// 2^23 pieces of them, or more than the budget has room for, before memory is taken; and
    /// Error{cancelled}. O(points + ends), and sorting the ends of each line.
    HatchLines(const Layer& layer, CosSin angle, double distance, double phase = 0,
               const LayerBudget& budget = {});

    /// Leaves of each line what is on others, too, or what is not. These have the same angle, distance and
    /// phase.
    /// O(lines + ends).
    void intersect(const HatchLines& others, const LayerBudget& budget = {});
    void subtract(const HatchLines& others, const LayerBudget& budget = {});

    [[nodiscard]] const LineFrame& frame() const noexcept { return frame_; }
    [[nodiscard]] std::size_t size() const noexcept { return begins_.size() - 1; }
    /// The number among all lines of line 0 of these.
    [[nodiscard]] std::int64_t first() const noexcept { return first_; }
    /// Where line i, from 0, lies.
    [[nodiscard]] double v(std::size_t i) const noexcept {
        return (static_cast<double>(first_ + static_cast<std::int64_t>(i)) + phase_) * distance_;
    }
    /// Whether its number among all lines is odd.
    [[nodiscard]] bool odd(std::size_t i) const noexcept {
        return ((first_ + static_cast<std::int64_t>(i)) & 1) != 0;
    }
    /// Where material begins and ends along it, in turn, in ascending order.
    [[nodiscard]] std::span<const double> ends(std::size_t i) const noexcept {
        return std::span(ends_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
    }
    /// The number of ends on all lines.
    [[nodiscard]] std::size_t total() const noexcept { return ends_.size(); }
    /// What they take.
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
    std::vector<std::uint32_t> begins_{0}; ///< of the ends of each line, and one past the last
    std::vector<double> ends_;
};

} // namespace lamella
