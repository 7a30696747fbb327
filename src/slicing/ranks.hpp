#pragma once

// Ranks: the integers that decide all topology (docs/conventions.md, "The rule of the plane").

#include "lamella/slicing/plan.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {

/// Returns the rank of a height: the number of planes below it. An edge is cut by exactly the planes
/// [rank(lower end), rank(upper end)). A height within the snap distance of a plane counts as on that plane:
/// below it under section_above, above it under section_below.
///
/// A grid with two cells per plane finds the planes, so a rank costs O(1) for evenly spaced planes and O(log
/// n) at worst.
class Ranks {
  public:
    /// Throws the errors of `check` for a plan.
    explicit Ranks(const Plan& plan);

    /// Returns the number of planes with z_i + snap < z (section_above) or with z_i - snap <= z
    /// (section_below).
    [[nodiscard]] std::uint32_t operator()(double z) const noexcept {
        const double position = (z - first_) * cells_per_mm_;
        const Cell& cell = cells_[cell_at(position)];
        // Most cells of evenly spaced planes hold no plane or one, at random: a branch would be mispredicted.
        if (cell.planes <= 1)
            return cell.below + static_cast<std::uint32_t>(cell.bound < z);
        const double* const bounds = bounds_.data() + cell.below;
        return cell.below +
               static_cast<std::uint32_t>(std::lower_bound(bounds, bounds + cell.planes, z) - bounds);
    }

    [[nodiscard]] std::uint32_t count() const noexcept { return static_cast<std::uint32_t>(z_.size()); }
    [[nodiscard]] double z(std::uint32_t plane) const noexcept {
        assert(plane < count());
        return z_[plane];
    }
    [[nodiscard]] PlaneRule rule() const noexcept { return rule_; }
    [[nodiscard]] double snap_mm() const noexcept { return snap_mm_; }

  private:
    struct Cell {
        double bound;         ///< bound of its first plane; infinite if it has none
        std::uint32_t below;  ///< number of planes in the cells before it
        std::uint32_t planes; ///< number of planes in it
    };

    /// Returns the cell of a scaled height: the first one for NaN and below all cells, the last one above
    /// all.
    [[nodiscard]] std::size_t cell_at(double position) const noexcept {
        // The conversion through a signed number is one instruction.
        return static_cast<std::size_t>(
            static_cast<std::int64_t>(std::min(std::max(0.0, position), last_cell_)));
    }

    std::vector<double> z_;
    /// Per plane: the plane is below those z that are greater than this bound.
    std::vector<double> bounds_;
    std::vector<Cell> cells_;
    double first_ = 0;
    double cells_per_mm_ = 0;
    double last_cell_ = 0;
    PlaneRule rule_;
    double snap_mm_;
};

} // namespace lamella
