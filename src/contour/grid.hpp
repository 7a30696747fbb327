#pragma once

// A grid of square cells, to find objects that are close to each other.

#include "contour/box2.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// The indices from 0 to size() - 1, for grids of all objects.
struct NumbersBelow {
    std::uint32_t end = 0;

    [[nodiscard]] std::size_t size() const noexcept { return end; }
    std::uint32_t operator[](std::size_t k) const noexcept { return static_cast<std::uint32_t>(k); }
};

/// Square cells over a box, and for each cell the indices of the objects that overlap it. Objects can be
/// boxes, segments or points, because the caller of `sort` specifies the cells of each object.
class Grid {
  public:
    /// Returns the size of cells for `count` objects, at least one, whose extents add up to `length`. There
    /// are about as many cells as objects, but the size of a cell is at least half the mean extent of
    /// objects, so that each object is in few cells.
    [[nodiscard]] static double cell_size(const Box2& whole, double count, double length) noexcept {
        const double width = whole.width();
        const double height = whole.height();
        return std::max({length / (2 * count), std::sqrt(width * height / count), (width + height) / count,
                         std::max(width, height) / largest_side});
    }

    /// `size` must be above 0 and at least 2^-15 of the box's sides. If it exceeds the box, it may be
    /// infinite.
    Grid(const Box2& whole, double size)
        : whole_(whole), size_(size), scale_(1 / size),
          columns_(static_cast<std::size_t>(whole.width() * scale_) + 1),
          rows_(static_cast<std::size_t>(whole.height() * scale_) + 1) {
        assert(size > 0 && std::isfinite(scale_));
        assert(whole.width() <= 2 * largest_side * size && whole.height() <= 2 * largest_side * size);
    }

    [[nodiscard]] std::size_t cells() const noexcept { return columns_ * rows_; }
    /// Returns the cell of a point of the box. Rounding is monotonic, so boxes that meet have a cell in
    /// common.
    [[nodiscard]] std::size_t cell(const Point2& p) const noexcept { return cell_at(column(p.x), row(p.y)); }
    [[nodiscard]] std::size_t column(double x) const noexcept { return along(x - whole_.x0, columns_); }
    [[nodiscard]] std::size_t row(double y) const noexcept { return along(y - whole_.y0, rows_); }
    [[nodiscard]] std::size_t cell_at(std::size_t column, std::size_t row) const noexcept {
        assert(column < columns_ && row < rows_);
        return row * columns_ + column;
    }

    /// Returns the box of a cell. Adjacent cells compute their common border from the same numbers, so cells,
    /// as half-open boxes, have neither overlaps nor gaps.
    [[nodiscard]] Box2 box(std::size_t cell) const noexcept {
        const std::size_t column = cell % columns_;
        const std::size_t row = cell / columns_;
        const auto border = [this](double first, double last, std::size_t k, std::size_t n) {
            return k == 0 ? first : k == n ? last : std::min(last, first + static_cast<double>(k) * size_);
        };
        return {border(whole_.x0, whole_.x1, column, columns_), border(whole_.y0, whole_.y1, row, rows_),
                border(whole_.x0, whole_.x1, column + 1, columns_),
                border(whole_.y0, whole_.y1, row + 1, rows_)};
    }

    /// Calls visit(cell) for every cell that the box meets. The box must lie within that of the grid.
    template <class Visit>
    void for_cells(const Box2& box, const Visit& visit) const {
        const std::size_t last_column = column(box.x1);
        const std::size_t last_row = row(box.y1);
        for (std::size_t j = row(box.y0); j <= last_row; ++j)
            for (std::size_t i = column(box.x0); i <= last_column; ++i)
                visit(cell_at(i, j));
    }

    /// Calls visit(cell) once for every cell whose distance from the segment is less than `margin` cells,
    /// which is far more than all rounding errors. The segment from a to b may reach beyond the grid.
    template <class Visit>
    void for_cells_along(const Point2& a, const Point2& b, const Visit& visit) const {
        double u0 = (a.x - whole_.x0) * scale_;
        double v0 = (a.y - whole_.y0) * scale_;
        double u1 = (b.x - whole_.x0) * scale_;
        double v1 = (b.y - whole_.y0) * scale_;
        if (v0 > v1) {
            std::swap(u0, u1);
            std::swap(v0, v1);
        }
        const double first_u = std::max(0.0, std::floor(std::min(u0, u1) - margin));
        const double last_u =
            std::min(static_cast<double>(columns_ - 1), std::floor(std::max(u0, u1) + margin));
        const double first_v = std::max(0.0, std::floor(v0 - margin));
        const double last_v = std::min(static_cast<double>(rows_ - 1), std::floor(v1 + margin));
        if (first_u > last_u || first_v > last_v)
            return;
        // A nearly horizontal segment meets at most two rows, and a slope computed from a small height is
        // inaccurate.
        const bool whole_rows = first_v == last_v || first_u == last_u || v1 - v0 < 0.25;
        const double slope = whole_rows ? 0 : (u1 - u0) / (v1 - v0);
        for (double v = first_v; v <= last_v; ++v) {
            double from = first_u;
            double to = last_u;
            if (!whole_rows) {
                const double enter = u0 + (std::max(v - margin, v0) - v0) * slope;
                const double leave = u0 + (std::min(v + 1 + margin, v1) - v0) * slope;
                from = std::max(from, std::floor(std::min(enter, leave) - margin));
                to = std::min(to, std::floor(std::max(enter, leave) + margin));
            }
            for (double u = from; u <= to; ++u)
                visit(cell_at(static_cast<std::size_t>(u), static_cast<std::size_t>(v)));
        }
    }

    /// Sorts indices into the cells: for_cells_of(index, visit) calls visit(cell) for each cell of an object.
    /// If there would be more than `most` entries, returns false and does nothing. O(cells + entries).
    template <class Numbers, class ForCellsOf>
    [[nodiscard]] bool sort(const Numbers& numbers, std::uint64_t most, const ForCellsOf& for_cells_of) {
        most = std::min<std::uint64_t>(most, std::numeric_limits<std::uint32_t>::max());
        ends_.assign(cells() + 1, 0);
        std::uint64_t entries = 0;
        for (std::size_t k = 0; k < numbers.size(); ++k) {
            for_cells_of(numbers[k], [&](std::size_t cell) {
                ++ends_[cell];
                ++entries;
            });
            if (entries > most)
                return false;
        }
        std::uint32_t sum = 0;
        for (std::uint32_t& end : ends_)
            end = sum += end;
        entries_.resize(sum);
        for (std::size_t k = numbers.size(); k-- > 0;) // backwards, so that indices ascend within cells
            for_cells_of(numbers[k], [&](std::size_t cell) { entries_[--ends_[cell]] = numbers[k]; });
        assert(ends_.front() == 0 && ends_.back() == entries);
        return true;
    }
    /// Returns the indices in a cell, in the order in which they were given.
    [[nodiscard]] std::span<const std::uint32_t> in_cell(std::size_t cell) const noexcept {
        assert(cell + 1 < ends_.size());
        return std::span(entries_).subspan(ends_[cell], ends_[cell + 1] - ends_[cell]);
    }

    static constexpr double margin = 0x1p-6; ///< see `for_cells_along`

  private:
    [[nodiscard]] std::size_t along(double distance, std::size_t cells) const noexcept {
        assert(distance >= 0);
        return std::min(cells - 1, static_cast<std::size_t>(distance * scale_));
    }

    static constexpr double largest_side = 0x1p15; // in cells

    Box2 whole_;
    double size_;
    double scale_;
    std::size_t columns_;
    std::size_t rows_;
    std::vector<std::uint32_t> ends_; ///< cell i has the entries [ends_[i], ends_[i + 1])
    std::vector<std::uint32_t> entries_;
};

} // namespace lamella
