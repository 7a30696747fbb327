#include "write/rounding_loss.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {

void RoundingLoss::add(const RoundedContour& contour, std::uint64_t layer) {
    const std::lock_guard lock(mutex_);
    first_layer_ = any_ ? std::min(first_layer_, layer) : layer;
    any_ = true;
    moved_mm_ = std::max(moved_mm_, contour.moved_mm);
    merged_ += contour.merged;
    lost_ += contour.lost ? 1 : 0;
}

std::vector<std::string> RoundingLoss::warnings() const {
    const std::lock_guard lock(mutex_);
    if (!any_)
        return {};
    return {fmt::format("rounding moved points by up to {:.3g} mm, merged {} of them with the one before and "
                        "left out {} contour{}, first in layer {}; smaller units, or a part nearer to the "
                        "origin, lose less",
                        moved_mm_, merged_, lost_, lost_ == 1 ? "" : "s", first_layer_)};
}

} // namespace lamella
