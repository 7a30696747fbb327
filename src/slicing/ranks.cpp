#include "slicing/ranks.hpp"

#include "slicing/stacking.hpp"

#include <cassert>
#include <cmath>
#include <limits>

namespace lamella {

Ranks::Ranks(const Plan& plan) : rule_(plan.rule), snap_mm_(plan.snap_mm) {
    check(plan);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    z_.reserve(plan.layers.size());
    bounds_.reserve(plan.layers.size());
    for (const PlannedLayer& layer : plan.layers) {
        z_.push_back(layer.z);
        bounds_.push_back(rule_ == PlaneRule::section_above ? layer.z + snap_mm_
                                                            : std::nextafter(layer.z - snap_mm_, -infinity));
    }
    if (z_.empty()) {
        cells_.push_back({infinity, 0, 0});
        return;
    }
    first_ = bounds_.front();
    const double height = bounds_.back() - first_;
    const std::size_t cells = z_.size() > 1 ? 2 * z_.size() : 1;
    cells_per_mm_ = static_cast<double>(cells) / height;
    if (!std::isfinite(cells_per_mm_))
        cells_per_mm_ = 0; // one cell for a single plane, and for planes too close to scale

    // The cell of a bound is computed by the same expression that looks up a vertex, and this expression is
    // monotone. Therefore a z in cell c lies above every bound of the cells before c, and below every bound
    // after c.
    last_cell_ = std::trunc(height * cells_per_mm_);
    if (!std::isfinite(last_cell_)) // the height overflows
        last_cell_ = 0;
    cells_.assign(static_cast<std::size_t>(last_cell_) + 1, {infinity, 0, 0});
    for (std::size_t plane = 0; plane < z_.size(); ++plane) {
        const double position = (bounds_[plane] - first_) * cells_per_mm_;
        Cell& cell = cells_[cell_at(position)];
        if (cell.planes == 0)
            cell.bound = bounds_[plane];
        ++cell.planes;
    }
    for (std::size_t c = 1; c < cells_.size(); ++c)
        cells_[c].below = cells_[c - 1].below + cells_[c - 1].planes;
    assert(cells_.back().below + cells_.back().planes == count());
    // The rule decides whether a vertex on a plane counts as above or below it.
    for ([[maybe_unused]] std::uint32_t plane = 0; plane < count(); ++plane)
        assert(rule_ == PlaneRule::section_below ? (*this)(z_[plane]) > plane : (*this)(z_[plane]) <= plane);
}

} // namespace lamella
