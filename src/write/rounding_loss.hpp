#pragma once

// What rounding does to contours beyond what anybody would miss.

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// What rounding did to a contour.
struct RoundedContour {
    double moved_mm = 0;          ///< the largest change of a coordinate
    std::uint64_t merged = 0;     ///< points that fell together with the one before
    bool lost = false;            ///< nothing is left of it
    std::uint64_t lost_lines = 0; ///< of hatch lines, those that shrank to a point
};

/// Takes out lines that rounding shrank to a point, of ends two by two. Gives how many ends are left, at the
/// front.
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
    /// Moves and merged points need not be counted where rounding cannot move by more: half a unit of the
    /// coarsest files that machines are used to. Contours and lines that are lost always are.
    static constexpr double unnoticed_mm = 0.01;

    /// From any threads, layers in any order.
    void add(const RoundedContour& contour, std::uint64_t layer);
    void add_height(double moved_mm, std::uint64_t layer);
    /// One line for contours, one for heights, or none.
    [[nodiscard]] std::vector<std::string> warnings() const;

  private:
    [[nodiscard]] std::string contours_text() const;

    mutable std::mutex mutex_;
    double moved_mm_ = 0;
    std::uint64_t merged_ = 0;
    std::uint64_t lost_ = 0;
    std::uint64_t lost_lines_ = 0;
    std::optional<std::uint64_t> first_layer_; ///< where anything was lost
    double moved_heights_mm_ = 0;
    std::optional<std::uint64_t> first_moved_height_;
};

} // namespace lamella
