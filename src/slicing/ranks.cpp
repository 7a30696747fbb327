#include "slicing/ranks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lamella {

Ranks::Ranks(const Plan& plan)
    : count_(static_cast<std::uint32_t>(plan.layers.size())),
      inclusive_(plan.rule == PlaneRule::section_below) {
    z_.reserve(count_);
    for (const PlannedLayer& layer : plan.layers)
        z_.push_back(layer.z);
    if (count_ == 0) {
        first_ = last_ = std::numeric_limits<double>::infinity();
        return;
    }
    first_ = z_.front();
    last_ = z_.back();

    const std::size_t cells = count_ > 1 ? 2 * std::size_t{count_} : 1;
    const double height = last_ - first_;
    cells_per_mm_ = static_cast<double>(cells) / height;
    if (!std::isfinite(cells_per_mm_))
        cells_per_mm_ = 0; // a single plane, or planes closer than doubles can scale: one cell holds them all

    // The cell of a plane is computed with the very expression that looks up a vertex, and that expression is
    // monotone. So a z in cell c lies above every plane of the cells before c, and below every plane after c.
    const std::size_t last_cell = static_cast<std::size_t>((last_ - first_) * cells_per_mm_);
    cells_.assign(last_cell + 2, 0);
    for (const double plane : z_)
        ++cells_[static_cast<std::size_t>((plane - first_) * cells_per_mm_) + 1];
    for (std::size_t c = 1; c < cells_.size(); ++c)
        cells_[c] += cells_[c - 1];
    z_.push_back(last_); // to look at where a cell holds no plane
}

} // namespace lamella
