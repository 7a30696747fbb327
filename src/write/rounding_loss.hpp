#pragma once

// What rounding does to contours beyond what anybody would miss.

#include <cstdint>
#include <mutex>
#include <string>
#include <vector>

namespace lamella {

/// What rounding did to a contour.
struct RoundedContour {
    double moved_mm = 0;      ///< the largest change of a coordinate
    std::uint64_t merged = 0; ///< points that fell together with the one before
    bool lost = false;        ///< nothing is left of it
};

/// Counts what a file loses to rounding.
class RoundingLoss {
  public:
    /// Contours that rounding cannot move by more need not be counted: half a unit of the coarsest files that
    /// machines are used to.
    static constexpr double unnoticed_mm = 0.01;

    /// From any threads, layers in any order.
    void add(const RoundedContour& contour, std::uint64_t layer);
    /// One line, or none.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    mutable std::mutex mutex_;
    double moved_mm_ = 0;
    std::uint64_t merged_ = 0;
    std::uint64_t lost_ = 0;
    std::uint64_t first_layer_ = 0; ///< where anything was lost
    bool any_ = false;
};

} // namespace lamella
