#pragma once

// Losses of contours by rounding that are worth a warning.

#include "lamella/write/layer_writer.hpp"

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// Changes of a contour by rounding.
struct RoundedContour {
    double moved_mm = 0;          ///< the largest change of a coordinate
    std::uint64_t merged = 0;     ///< points equal to the one before
    bool lost = false;            ///< no point is left
    std::uint64_t lost_lines = 0; ///< hatch lines that shrank to a point
};

/// Removes lines that rounding shrank to a point; each line is two consecutive ends. Returns the number of
/// remaining ends, which are moved to the front.
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

/// Counts what a file loses to rounding.
class RoundingLoss {
  public:
    /// Callers need not count moves and merged points if rounding cannot move by more than this: half a unit
    /// of the coarsest files that machines commonly take. Lost contours and lines are always counted.
    static constexpr double unnoticed_mm = 0.01;

    /// May be called from any threads, for layers in any order.
    void add(const RoundedContour& contour, std::uint64_t layer);
    void add_height(double moved_mm, std::uint64_t layer);
    void add(const WriteLosses::Rounded& other);
    [[nodiscard]] WriteLosses::Rounded losses() const;
    /// Returns at most one line for contours and one for heights.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    mutable std::mutex mutex_;
    WriteLosses::Rounded losses_;
};

} // namespace lamella
