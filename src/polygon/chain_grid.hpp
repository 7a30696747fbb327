#pragma once

// Where the chains of a layer are: which of them can meet, and which lie below a point.

#include "polygon/monotone_chains.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

struct ChainBox {
    double x0;
    double y0;
    double x1;
    double y1;

    static ChainBox of(const Point2& a, const Point2& b) noexcept {
        return {std::min(a.x, b.x), std::min(a.y, b.y), std::max(a.x, b.x), std::max(a.y, b.y)};
    }
    void add(const ChainBox& other) noexcept {
        x0 = std::min(x0, other.x0);
        y0 = std::min(y0, other.y0);
        x1 = std::max(x1, other.x1);
        y1 = std::max(y1, other.y1);
    }
    [[nodiscard]] bool meets(const ChainBox& other) const noexcept {
        return x0 <= other.x1 && other.x0 <= x1 && y0 <= other.y1 && other.y0 <= y1;
    }
};

/// The chains of a layer in pieces of about the size of the cells of a grid, and for each cell the pieces
/// whose boxes reach into it. A chain is only cut where it is long for the layer: one around its corner would
/// have all of it in its box.
class ChainGrid {
  public:
    /// None for layers that have no chains or defeat a grid: extents beyond numbers, many long pieces aslant.
    /// O(chains).
    [[nodiscard]] static std::optional<ChainGrid> of(const MonotoneChains& chains);

    [[nodiscard]] std::span<const Chain> pieces() const noexcept { return pieces_; }
    [[nodiscard]] const ChainBox& box(std::uint32_t piece) const noexcept { return boxes_[piece]; }

    [[nodiscard]] std::size_t cells() const noexcept { return ends_.size() - 1; }
    /// The cell of a point of the layer. Rounding keeps the order of numbers, so boxes that meet have a cell
    /// in common.
    [[nodiscard]] std::size_t cell(double x, double y) const noexcept {
        return row(y) * columns_ + column(x);
    }
    [[nodiscard]] std::size_t column(double x) const noexcept { return along(x - all_.x0, columns_); }
    [[nodiscard]] std::size_t row(double y) const noexcept { return along(y - all_.y0, rows_); }
    [[nodiscard]] std::size_t cell_at(std::size_t column, std::size_t row) const noexcept {
        return row * columns_ + column;
    }
    /// Numbers of the pieces in a cell, ascending.
    [[nodiscard]] std::span<const std::uint32_t> in_cell(std::size_t cell) const noexcept {
        return std::span(sorted_).subspan(ends_[cell], ends_[cell + 1] - ends_[cell]);
    }

  private:
    void take_chains(const MonotoneChains& chains);
    void take(const MonotoneChains& chains, const Chain& chain, double longest);
    bool lay_out();
    void fill();
    [[nodiscard]] std::size_t along(double distance, std::size_t cells) const noexcept {
        return std::min(cells - 1, static_cast<std::size_t>(distance * scale_));
    }
    template <class Visit>
    void for_cells(const ChainBox& box, Visit visit) const;

    std::vector<Chain> pieces_;
    std::vector<ChainBox> boxes_;
    ChainBox all_{};
    double scale_ = 0;
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    std::vector<std::uint32_t> ends_; ///< of cell i the places [ends_[i], ends_[i + 1]) in sorted_
    std::vector<std::uint32_t> sorted_;
};

} // namespace lamella
