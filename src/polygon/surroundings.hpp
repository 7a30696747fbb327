#pragma once

// Finds edges and winding numbers around the left ends of rings, also where rings touch, coincide and cross.

#include "polygon/edges_by_x.hpp"
#include "polygon/left_end.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/ring_copies.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

/// The surroundings of the left end of a ring.
struct Surroundings {
    Windings winding;
    Windings below_all;              ///< winding numbers below all edges that coincide with the ring's lowest
                                     ///< edge there
    const RingEdge* below = nullptr; ///< the next lower edge of another ring that bounds an area
};

/// Finds the surroundings of rings, each of which represents its copies. Edges that span no left end of these
/// rings are skipped, chain by chain. Exact except for `below` where edges cross.
class SurroundingsSearch {
  public:
    /// `turns` is the contribution of each ring to the winding numbers. `by_area` has the ranks of
    /// representatives in contact, the largest first. `asked` is the subset of `representatives` for which
    /// `find` will be called. All arguments must outlive the search. O(n log c) for n edges that span left
    /// ends of the c rings in `asked`.
    SurroundingsSearch(const MonotoneChains& chains, std::span<const LeftEnd> ends, const RingCopies& copies,
                       std::span<const Windings> turns, std::span<const std::uint32_t> representatives,
                       std::span<const std::uint32_t> by_area, std::span<const std::uint32_t> asked);

    /// Returns the surroundings of a ring in `asked`. The result lives as long as the search. O(log n log c),
    /// and more where edges cross or fold.
    [[nodiscard]] Surroundings find(std::uint32_t ring) const;

    /// Returns the number of crossing edges that `find` examines for a ring, each a few times.
    [[nodiscard]] std::uint64_t crossing_edges_at(std::uint32_t ring) const;

  private:
    void add_edges(const Chain& chain, const Windings& net, std::size_t leaf);
    [[nodiscard]] std::int64_t place_in_order(std::uint32_t ring, bool inside_above) const noexcept;
    [[nodiscard]] Windings net_winding(std::uint32_t ring) const noexcept;
    [[nodiscard]] std::int64_t count_equal(double x, const RingEdge& edge) const;

    const MonotoneChains& chains_;
    std::span<const LeftEnd> ends_;
    const RingCopies& copies_;
    std::span<const Windings> turns_;
    std::span<const std::uint32_t> by_area_;
    EdgesByX edges_;
};

} // namespace lamella
