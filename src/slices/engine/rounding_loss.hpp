#pragma once

// Losses of contours by rounding that are worth a finding.

#include "lamella/findings/findings.hpp"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>

namespace lamella {

/// Changes of a contour by rounding.
struct RoundedContour {
    double moved_mm = 0;          ///< the largest change of a coordinate
    std::uint64_t merged = 0;     ///< points equal to the previous point
    bool lost = false;            ///< true if no point remains
    std::uint64_t lost_lines = 0; ///< hatch lines that shrank to a point
};

/// Removes lines that rounding shrank to a point. A line is two consecutive points. Returns the number of
/// remaining points, which are moved to the front.
template <class Point>
[[nodiscard]] std::size_t without_lost_lines(std::span<Point> ends) noexcept {
    std::size_t kept = 0;
    for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
        if (ends[i] == ends[i + 1])
            continue;
        ends[kept++] = ends[i];
        ends[kept++] = ends[i + 1];
    }
    return kept;
}

/// Counts the losses of a file by rounding.
class RoundingLoss {
  public:
    /// Moves and merged points of a contour do not count if rounding moves no point by more than this. It is
    /// half a unit of the coarsest files that machines commonly accept. Lost contours and lines are always
    /// counted.
    static constexpr double unnoticed_mm = 0.01;

    /// May be called from any threads, for layers in any order.
    void add(const RoundedContour& contour, std::uint64_t layer);
    void add_height(double moved_mm, std::uint64_t layer);
    /// Returns what was added, the same for any order.
    [[nodiscard]] Findings findings() const;

  private:
    mutable std::mutex mutex_;
    Findings found_;
};

} // namespace lamella
