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

std::string contours_text(const WriteLosses::Rounded& losses) {
    std::string text;
    if (losses.moved_mm > RoundingLoss::unnoticed_mm)
        text = fmt::format("moved points by up to {:.3g} mm, merged {} of them with the one before",
                           losses.moved_mm, losses.merged);
    if (losses.contours + losses.lines > 0)
        text += fmt::format("{}left out {}", text.empty() ? "" : " and ",
                            lost_text(losses.contours, losses.lines));
    return fmt::format(
        "rounding {}, first in layer {}; a part nearer to the origin, or smaller units where the format "
        "has units, lose less",
        text, losses.layer);
}

} // namespace

void WriteLosses::Rounded::add(const Rounded& other) noexcept {
    moved_mm = std::max(moved_mm, other.moved_mm);
    merged += other.merged;
    contours += other.contours;
    lines += other.lines;
    layer = std::min(layer, other.layer);
    moved_heights_mm = std::max(moved_heights_mm, other.moved_heights_mm);
    height = std::min(height, other.height);
}

void RoundingLoss::add(const RoundedContour& contour, std::uint64_t layer) {
    const bool noticed = contour.moved_mm > unnoticed_mm || contour.lost || contour.lost_lines != 0;
    add({.moved_mm = contour.moved_mm,
         .merged = contour.merged,
         .contours = contour.lost ? std::uint64_t{1} : 0,
         .lines = contour.lost_lines,
         .layer = noticed ? layer : WriteLosses::Rounded::no_layer});
}

void RoundingLoss::add_height(double moved_mm, std::uint64_t layer) {
    if (moved_mm > unnoticed_mm)
        add({.moved_heights_mm = moved_mm, .height = layer});
}

void RoundingLoss::add(const WriteLosses::Rounded& other) {
    const std::lock_guard lock(mutex_);
    losses_.add(other);
}

WriteLosses::Rounded RoundingLoss::losses() const {
    const std::lock_guard lock(mutex_);
    return losses_;
}

std::vector<std::string> RoundingLoss::warnings() const {
    const WriteLosses::Rounded losses = this->losses();
    std::vector<std::string> lines;
    if (losses.layer != WriteLosses::Rounded::no_layer)
        lines.push_back(contours_text(losses));
    if (losses.height != WriteLosses::Rounded::no_layer)
        lines.push_back(
            fmt::format("rounding moved heights of layers by up to {:.3g} mm, first in layer {}; smaller "
                        "units lose less",
                        losses.moved_heights_mm, losses.height));
    return lines;
}

} // namespace lamella
