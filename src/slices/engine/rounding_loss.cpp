#include "slices/engine/rounding_loss.hpp"

namespace lamella {

void RoundingLoss::add(const RoundedContour& contour, std::uint64_t layer) {
    const std::lock_guard lock(mutex_);
    if (contour.moved_mm > unnoticed_mm)
        found_.add({.kind = FindingKind::rounded_points,
                    .count = 1,
                    .amount = static_cast<double>(contour.merged),
                    .largest = contour.moved_mm,
                    .first_layer = layer});
    if (contour.lost)
        found_.add({.kind = FindingKind::vanished_contours, .count = 1, .first_layer = layer});
    if (contour.lost_lines > 0)
        found_.add(
            {.kind = FindingKind::vanished_hatch_lines, .count = contour.lost_lines, .first_layer = layer});
}

void RoundingLoss::add_height(double moved_mm, std::uint64_t layer) {
    const std::lock_guard lock(mutex_);
    if (moved_mm > unnoticed_mm)
        found_.add(
            {.kind = FindingKind::rounded_heights, .count = 1, .largest = moved_mm, .first_layer = layer});
}

Findings RoundingLoss::findings() const {
    const std::lock_guard lock(mutex_);
    return found_;
}

} // namespace lamella
