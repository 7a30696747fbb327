#pragma once

// What lies around the left ends of rings, in any layer: also where rings touch, coincide and cross.

#include "polygon/edges_by_x.hpp"
#include "polygon/left_end.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/ring_copies.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

/// What is found at the left end of a ring.
struct Surroundings {
    Windings winding;
    Windings below_all;              ///< below all edges that coincide with its lowest one there
    const RingEdge* below = nullptr; ///< the next edge below that bounds something, of another ring
};

/// Finds the surroundings of rings that are given by their representatives. Edges that reach over no left end
/// of these are left out, chain by chain. Exact but for `below` where edges cross.
class SurroundingsSearch {
  public:
    /// `turns`: what each ring adds; `by_area`: of representatives in contact their places, the largest
    /// first; `asked`: those of all `representatives` whose surroundings will be asked for. All arguments are
    /// to outlive the search. O(n log c) for n edges that reach over left ends of the c rings asked for.
    SurroundingsSearch(const MonotoneChains& chains, std::span<const LeftEnd> ends, const RingCopies& copies,
                       std::span<const Windings> turns, std::span<const std::uint32_t> representatives,
                       std::span<const std::uint32_t> by_area, std::span<const std::uint32_t> asked);

    /// Of a ring asked for. The result lives as long as the search. O(log n log c), and more where edges
    /// cross or fold.
    [[nodiscard]] Surroundings find(std::uint32_t ring) const;

    /// How many edges that cross others `find` looks at for a ring, some times each.
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
