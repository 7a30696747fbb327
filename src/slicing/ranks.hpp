#pragma once

// Ranks: the integers on which all topology is decided (docs/conventions.md, "The rule of the plane").

#include "lamella/slicing/plan.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// Gives each height its rank, the number of planes below it. An edge is cut by exactly the planes
/// [rank(lower end), rank(upper end)).
///
/// The planes are looked up through a grid with two cells per plane, so that a rank costs O(1) for
/// evenly spaced planes and O(log n) for the most uneven ones.
class Ranks {
  public:
    explicit Ranks(const Plan& plan);

    /// section_above: the number of planes with z_i < z. section_below: with z_i <= z.
    [[nodiscard]] std::uint32_t operator()(double z) const noexcept {
        if (!(z > first_)) // also the common case "on the first plane"
            return inclusive_ && z == first_ ? 1 : 0;
        if (z > last_)
            return count_;
        const auto cell = static_cast<std::size_t>((z - first_) * cells_per_mm_);
        std::uint32_t low = cells_[cell];
        std::uint32_t high = cells_[cell + 1];
        // Nearly every cell of evenly spaced planes holds one plane or none, and which is random: no branch.
        if (high - low <= 1)
            return low + static_cast<std::uint32_t>(static_cast<int>(low < high) &
                                                    static_cast<int>(is_below(z_[low], z)));
        while (low < high) {
            const std::uint32_t middle = (low + high) / 2;
            if (is_below(z_[middle], z))
                low = middle + 1;
            else
                high = middle;
        }
        return low;
    }

    /// How many planes there are.
    [[nodiscard]] std::uint32_t count() const noexcept { return count_; }
    [[nodiscard]] double z(std::uint32_t plane) const noexcept { return z_[plane]; }
    [[nodiscard]] PlaneRule rule() const noexcept {
        return inclusive_ ? PlaneRule::section_below : PlaneRule::section_above;
    }

  private:
    [[nodiscard]] bool is_below(double plane, double z) const noexcept {
        return inclusive_ ? plane <= z : plane < z;
    }

    std::vector<double> z_;
    /// cells_[c] <= rank of every z in cell c <= cells_[c + 1].
    std::vector<std::uint32_t> cells_;
    double first_ = 0;
    double last_ = 0;
    double cells_per_mm_ = 0;
    std::uint32_t count_ = 0;
    bool inclusive_ = false;
};

} // namespace lamella
