#pragma once

// A grid over the chains of a layer, which finds chains that can meet, and chains below a point.

#include "contour/grid.hpp"
#include "polygon/monotone_chains.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// The rings of a layer, divided into pieces, and for each grid cell the pieces whose boxes overlap it. A
/// small ring of few chains is one piece. In other rings each chain is a piece; long chains are cut, because
/// their boxes would be mostly empty. So pieces are about as large as cells.
class ChainGrid {
  public:
    /// Returns nullopt for layers without chains and for layers for which a grid is useless, with extents
    /// that overflow or many long diagonal pieces. The chains must outlive the grid. Boxes are grown by
    /// `reach`. O(chains).
    [[nodiscard]] static std::optional<ChainGrid> of(const MonotoneChains& chains, double reach = 0);

    [[nodiscard]] std::span<const Chain> pieces() const noexcept { return pieces_; }
    [[nodiscard]] static bool whole_ring(const Chain& piece) noexcept { return way::turns(piece.ways); }
    /// Returns the chains of a piece: all chains of its ring, or the piece itself.
    [[nodiscard]] std::span<const Chain> chains(const Chain& piece) const noexcept {
        return whole_ring(piece) ? all_chains_->of_ring(piece.ring) : std::span(&piece, 1);
    }
    [[nodiscard]] const Box2& box(std::uint32_t piece) const noexcept { return boxes_[piece]; }
    /// Returns the cells with the indices of their pieces, in ascending order.
    [[nodiscard]] const Grid& cells() const noexcept { return *cells_; }

    /// Returns whether many pieces lie in few cells, such as small nested rings. A search through the cells
    /// of each piece would then take too long.
    [[nodiscard]] bool full() const noexcept;

    /// Returns whether p, a point of `ring`, may lie in another ring, because it is in the box of another
    /// ring or because there are too many large rings to test. Searches one cell.
    [[nodiscard]] bool surrounded(const Point2& p, std::uint32_t ring) const noexcept;

  private:
    ChainGrid(const MonotoneChains& chains, double reach) : all_chains_(&chains), reach_(reach) {}
    void take_rings();
    void take(const Chain& chain, double longest);
    bool sort();

    static constexpr std::size_t few_chains = 32; ///< at most this many chains of a ring form one piece
    static constexpr std::size_t few_large_rings = 16;

    const MonotoneChains* all_chains_;
    double reach_;
    std::vector<Chain> pieces_;
    std::vector<Box2> boxes_;
    std::vector<std::uint32_t> large_rings_; ///< rings of several pieces
    Box2 all_{};
    std::optional<Grid> cells_;
};

} // namespace lamella
