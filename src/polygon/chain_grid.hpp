#pragma once

// Where the chains of a layer are: which of them can meet, and which lie below a point.

#include "polygon/grid.hpp"
#include "polygon/monotone_chains.hpp"

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
    /// The chains are to outlive the grid. Boxes are grown by `reach`, if any.
    [[nodiscard]] static std::optional<ChainGrid> of(const MonotoneChains& chains, double reach = 0);

    [[nodiscard]] std::span<const Chain> pieces() const noexcept { return pieces_; }
    [[nodiscard]] static bool whole_ring(const Chain& piece) noexcept { return way::turns(piece.ways); }
    /// What a piece consists of: all chains of its ring, or itself.
    [[nodiscard]] std::span<const Chain> chains(const Chain& piece) const noexcept {
        return whole_ring(piece) ? all_chains_->of_ring(piece.ring) : std::span(&piece, 1);
    }
    [[nodiscard]] const Box2& box(std::uint32_t piece) const noexcept { return boxes_[piece]; }
    /// The cells, and the numbers of the pieces in them, ascending.
    [[nodiscard]] const Grid& cells() const noexcept { return *cells_; }

    /// Whether many pieces lie in few cells, such as small rings within one another: then to look at the
    /// cells of each piece takes too long.
    [[nodiscard]] bool full() const noexcept;

    /// Whether p, a point of the ring, may lie in another one: it is in the box of another one, or there are
    /// too many large rings to look. Takes a look at one cell.
    [[nodiscard]] bool surrounded(const Point2& p, std::uint32_t ring) const noexcept;

  private:
    ChainGrid(const MonotoneChains& chains, double reach) : all_chains_(&chains), reach_(reach) {}
    void take_rings();
    void take(const Chain& chain, double longest);
    bool sort();

    static constexpr std::size_t few_chains = 32; ///< of a ring that is one piece
    static constexpr std::size_t few_large_rings = 16;

    const MonotoneChains* all_chains_;
    double reach_;
    std::vector<Chain> pieces_;
    std::vector<Box2> boxes_;
    std::vector<std::uint32_t> large_rings_; ///< those in several pieces
    Box2 all_{};
    std::optional<Grid> cells_;
};

} // namespace lamella
