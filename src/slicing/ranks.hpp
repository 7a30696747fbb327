#pragma once

// Ranks: the integers on which all topology is decided (docs/conventions.md, "The rule of the plane").

#include "lamella/slicing/plan.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {

/// Gives each height its rank, the number of planes below it. An edge is cut by exactly the planes
/// [rank(lower end), rank(upper end)). Heights no further from a plane than the snap distance of the plan
/// count as on it: below it under section_above, above it under section_below.
///
/// The planes are looked up through a grid with two cells per plane, so that a rank costs O(1) for
/// evenly spaced planes and O(log n) for the most uneven ones.
class Ranks {
  public:
    /// Throws what `check` of a plan throws.
    explicit Ranks(const Plan& plan);

    /// section_above: the number of planes with z_i + snap < z. section_below: with z_i - snap <= z.
    [[nodiscard]] std::uint32_t operator()(double z) const noexcept {
        const double place = (z - first_) * cells_per_mm_;
        const Cell& cell = cells_[cell_at(place)];
        // Nearly every cell of evenly spaced planes holds one plane or none, and which is random: no branch.
        if (cell.planes <= 1)
            return cell.below + static_cast<std::uint32_t>(cell.bound < z);
        const double* const bounds = bounds_.data() + cell.below;
        return cell.below +
               static_cast<std::uint32_t>(std::lower_bound(bounds, bounds + cell.planes, z) - bounds);
    }

    /// How many planes there are.
    [[nodiscard]] std::uint32_t count() const noexcept { return static_cast<std::uint32_t>(z_.size()); }
    [[nodiscard]] double z(std::uint32_t plane) const noexcept {
        assert(plane < count());
        return z_[plane];
    }
    [[nodiscard]] PlaneRule rule() const noexcept { return rule_; }
    [[nodiscard]] double snap_mm() const noexcept { return snap_mm_; }

  private:
    /// What a lookup needs to know of a cell.
    struct Cell {
        double bound;         ///< of its first plane; infinite where it has none
        std::uint32_t below;  ///< planes in the cells before it
        std::uint32_t planes; ///< in it
    };

    /// The first cell for what lies below all cells (or is no number), the last one for what lies above.
    [[nodiscard]] std::size_t cell_at(double place) const noexcept {
        // By way of a signed number, which is one instruction.
        return static_cast<std::size_t>(
            static_cast<std::int64_t>(std::min(std::max(0.0, place), last_cell_)));
    }

    std::vector<double> z_;
    /// Per plane: it is below those z that are greater than this.
    std::vector<double> bounds_;
    std::vector<Cell> cells_;
    double first_ = 0;
    double cells_per_mm_ = 0;
    double last_cell_ = 0;
    PlaneRule rule_;
    double snap_mm_;
};

} // namespace lamella
