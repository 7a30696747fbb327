#include "write/rounding_loss.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

namespace {

std::string lost_text(std::uint64_t contours, std::uint64_t lines) {
    const std::string text =
        contours != 0 || lines == 0 ? fmt::format("{} contour{}", contours, contours == 1 ? "" : "s") : "";
    if (lines == 0)
        return text;
    return fmt::format("{}{}{} hatch line{}", text, text.empty() ? "" : " and ", lines,
                       lines == 1 ? "" : "s");
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

std::vector<std::string> RoundingLoss::warnings() const {
    const std::lock_guard lock(mutex_);
    if (!first_layer_)
        return {};
    const std::string moved =
        moved_mm_ > unnoticed_mm
            ? fmt::format("moved points by up to {:.3g} mm, merged {} of them with the one before and ",
                          moved_mm_, merged_)
            : std::string();
    return {fmt::format("rounding {}left out {}, first in layer {}; a part nearer to the origin, or smaller "
                        "units where the format has units, lose less",
                        moved, lost_text(lost_, lost_lines_), *first_layer_)};
}

} // namespace lamella
