#include "write/rounding_loss.hpp"

#include "core/counted.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

namespace {

std::string lost_text(std::uint64_t contours, std::uint64_t lines) {
    std::string text = contours != 0 ? counted(contours, "contour") : "";
    if (lines != 0)
        text += (text.empty() ? "" : " and ") + counted(lines, "hatch line");
    return text;
}

} // namespace

void RoundingLoss::add(const RoundedContour& contour, std::uint64_t layer) {
    const std::lock_guard lock(mutex_);
    if (contour.moved_mm > unnoticed_mm || contour.lost || contour.lost_lines != 0)
        first_layer_ = std::min(first_layer_.value_or(layer), layer);
    moved_mm_ = std::max(moved_mm_, contour.moved_mm);
    merged_ += contour.merged;
    lost_ += contour.lost ? 1 : 0;
    lost_lines_ += contour.lost_lines;
}

void RoundingLoss::add_height(double moved_mm, std::uint64_t layer) {
    if (!(moved_mm > unnoticed_mm))
        return;
    const std::lock_guard lock(mutex_);
    first_moved_height_ = std::min(first_moved_height_.value_or(layer), layer);
    moved_heights_mm_ = std::max(moved_heights_mm_, moved_mm);
}

std::vector<std::string> RoundingLoss::warnings() const {
    const std::lock_guard lock(mutex_);
    std::vector<std::string> lines;
    if (first_layer_)
        lines.push_back(contours_text());
    if (first_moved_height_)
        lines.push_back(
            fmt::format("rounding moved heights of layers by up to {:.3g} mm, first in layer {}; smaller "
                        "units lose less",
                        moved_heights_mm_, *first_moved_height_));
    return lines;
}

std::string RoundingLoss::contours_text() const {
    std::string text;
    if (moved_mm_ > unnoticed_mm)
        text = fmt::format("moved points by up to {:.3g} mm, merged {} of them with the one before",
                           moved_mm_, merged_);
    if (lost_ + lost_lines_ > 0)
        text += fmt::format("{}left out {}", text.empty() ? "" : " and ", lost_text(lost_, lost_lines_));
    return fmt::format(
        "rounding {}, first in layer {}; a part nearer to the origin, or smaller units where the format "
        "has units, lose less",
        text, *first_layer_);
}

} // namespace lamella
