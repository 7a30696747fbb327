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

/// The rings of a layer in pieces of about the size of the cells of a grid, and for each cell the pieces
/// whose boxes reach into it. A small ring of few chains is one piece, with all ways; of others, each chain
/// is one, cut only where it is long for the layer: one around its corner would have all of it in its box.
class ChainGrid {
  public:
    /// None for layers that have no chains or defeat a grid: extents beyond numbers, many long pieces aslant.
    /// O(chains).
    /// The chains are to outlive the grid.
    [[nodiscard]] static std::optional<ChainGrid> of(const MonotoneChains& chains);

    [[nodiscard]] std::span<const Chain> pieces() const noexcept { return pieces_; }
    [[nodiscard]] static bool whole_ring(const Chain& piece) noexcept { return way::turns(piece.ways); }
    /// What a piece consists of: all chains of its ring, or itself.
    [[nodiscard]] std::span<const Chain> chains(const Chain& piece) const noexcept {
        return whole_ring(piece) ? all_chains_->of_ring(piece.ring) : std::span(&piece, 1);
    }
    [[nodiscard]] const ChainBox& box(std::uint32_t piece) const noexcept { return boxes_[piece]; }

    /// Whether many pieces lie in few cells, such as small rings within one another: then to look at the
    /// cells of each piece takes too long.
    [[nodiscard]] bool crowded() const noexcept { return pairs_ > 256 * pieces_.size() + 65536; }

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
    /// Whether p, a point of the ring, may lie in another one: it is in the box of another one, or there are
    /// too many large rings to look. Takes a look at one cell.
    [[nodiscard]] bool surrounded(const Point2& p, std::uint32_t ring) const noexcept;

  private:
    explicit ChainGrid(const MonotoneChains& chains) : all_chains_(&chains) {}
    void take_rings();
    void take(const Chain& chain, double longest);
    bool lay_out();
    void fill();
    [[nodiscard]] std::size_t along(double distance, std::size_t cells) const noexcept {
        return std::min(cells - 1, static_cast<std::size_t>(distance * scale_));
    }
    template <class Visit>
    void for_cells(const ChainBox& box, Visit visit) const;

    static constexpr std::size_t few_chains = 32; ///< of a ring that is one piece
    static constexpr std::size_t few_large_rings = 16;

    const MonotoneChains* all_chains_;
    std::vector<Chain> pieces_;
    std::vector<ChainBox> boxes_;
    std::vector<std::uint32_t> large_rings_; ///< those in several pieces
    ChainBox all_{};
    double scale_ = 0;
    std::size_t columns_ = 0;
    std::size_t rows_ = 0;
    std::vector<std::uint32_t> ends_; ///< of cell i the places [ends_[i], ends_[i + 1]) in sorted_
    std::vector<std::uint32_t> sorted_;
    std::uint64_t pairs_ = 0; ///< of pieces in a cell, over all cells
};

} // namespace lamella
