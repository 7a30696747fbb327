#pragma once

// A coarse map of the occupied areas of a layer.

#include "lamella/contour/layer.hpp"

#include "contour/box2.hpp"

#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>

namespace lamella {

/// The occupied cells of a coarse grid over a layer. They quickly exclude boxes that are far from all
/// contents. Points beyond the layer count as points at its edge.
class Occupied {
  public:
    explicit Occupied(const Layer& layer) : whole_(box_of(layer.points.span())) {}
    /// Returns the cells that the boxes of the rings of a layer occupy.
    [[nodiscard]] static Occupied by_rings(const Layer& layer) {
        Occupied occupied(layer);
        for (std::size_t i = 0; i < layer.rings; ++i)
            occupied.add(box_of(layer.contour(i)));
        return occupied;
    }

    void add(const Box2& box) {
        for_rows(box, [](std::uint64_t& row, std::uint64_t columns) {
            row |= columns;
            return true;
        });
    }
    /// Returns whether a box may contain something.
    [[nodiscard]] bool any_within(const Box2& box) {
        return !for_rows(box, [](std::uint64_t& row, std::uint64_t columns) { return (row & columns) == 0; });
    }

  private:
    static constexpr unsigned side = 64;

    static unsigned cell(double along, double extent) noexcept {
        const double cells = along / extent * side;
        return !(cells > 0) ? 0 : cells >= side ? side - 1 : static_cast<unsigned>(cells);
    }
    /// Calls `visit` for all rows of a box, with bits for its columns, until it returns false.
    template <class Visit>
    bool for_rows(const Box2& box, const Visit& visit) {
        const unsigned first = cell(box.x0 - whole_.x0, whole_.width());
        const unsigned last = cell(box.x1 - whole_.x0, whole_.width());
        assert(first <= last);
        const std::uint64_t columns = (~std::uint64_t{0} >> (side - 1 - (last - first))) << first;
        const unsigned last_row = cell(box.y1 - whole_.y0, whole_.height());
        for (unsigned row = cell(box.y0 - whole_.y0, whole_.height()); row <= last_row; ++row)
            if (!visit(rows_[row], columns))
                return false;
        return true;
    }

    Box2 whole_;
    std::array<std::uint64_t, side> rows_{};
};

} // namespace lamella
