#include "polygon/surroundings.hpp"

#include "lamella/polygon/nesting.hpp"

#include <algorithm>
#include <cassert>
#include <limits>

namespace lamella {

namespace {

std::vector<double> abscissae_of(std::span<const LeftEnd> ends, std::span<const std::uint32_t> rings) {
    std::vector<double> abscissae;
    abscissae.reserve(rings.size());
    for (const std::uint32_t ring : rings)
        abscissae.push_back(ends[ring].line.lo.x);
    return abscissae;
}

RingEdge opposite(RingEdge edge) noexcept {
    edge.order = -edge.order - 1;
    return edge;
}

} // namespace

SurroundingsSearch::SurroundingsSearch(const MonotoneChains& chains, std::span<const LeftEnd> ends,
                                       const RingCopies& copies, std::span<const Windings> turns,
                                       std::span<const std::uint32_t> representatives,
                                       std::span<const std::uint32_t> by_area,
                                       std::span<const std::uint32_t> asked)
    : chains_(chains), ends_(ends), copies_(copies), turns_(turns), by_area_(by_area),
      edges_(abscissae_of(ends, asked)) {
    std::size_t near = 0;
    for (const std::uint32_t ring : representatives) {
        if (ends_[ring].flat)
            continue;
        const Windings net = net_winding(ring);
        for (const Chain& chain : chains_.of_ring(ring)) {
            const std::size_t from = edges_.leaf(chain.front.x, near);
            near = edges_.leaf(chain.back.x, from);
            if (from != near) // other edges span no left end
                add_edges(chain, net, from);
        }
    }
    edges_.order();
}

/// Adds the edges of a chain that span left ends. `net` is its ring's winding, `leaf` that of its first
/// point.
void SurroundingsSearch::add_edges(const Chain& chain, const Windings& net, std::size_t leaf) {
    assert(!way::turns(chain.ways));
    const std::uint32_t ring = chain.ring;
    const bool rightwards = (chain.ways & way::right) != 0;
    const bool inside_above = rightwards == ends_[ring].rightwards;
    const Windings step = inside_above ? net : -net;
    const std::int64_t order = place_in_order(ring, inside_above);
    for (std::uint32_t i = 0; i < chain.segments; ++i) {
        const Point2& a = chains_.point(chain, i);
        const Point2& b = chains_.point(chain, i + 1);
        const std::size_t next = edges_.leaf(b.x, leaf);
        if (next != leaf)
            edges_.add({rightwards ? Segment{a, b} : Segment{b, a}, ring, step, order}, std::min(leaf, next),
                       std::max(leaf, next));
        leaf = next;
    }
}

std::int64_t SurroundingsSearch::place_in_order(std::uint32_t ring, bool inside_above) const noexcept {
    const auto position = static_cast<std::int64_t>(by_area_[ring]);
    return inside_above ? position : -position - 1;
}

/// Returns how many times the copies of a ring wind around its inside.
Windings SurroundingsSearch::net_winding(std::uint32_t ring) const noexcept {
    Windings net;
    for (std::uint32_t copy = ring; copy != Nesting::none; copy = copies_.next(copy))
        net += ends_[copy].rightwards ? turns_[copy] : -turns_[copy];
    return net;
}

std::int64_t SurroundingsSearch::count_equal(double x, const RingEdge& edge) const {
    std::int64_t n = 0;
    edges_.for_columns_at(x, [&](const EdgeColumn& column) { n += column.count_equal(x, edge); });
    return n;
}

std::uint64_t SurroundingsSearch::crossing_edges_at(std::uint32_t ring) const {
    std::uint64_t n = 0;
    edges_.for_columns_at(ends_[ring].line.lo.x, [&](const EdgeColumn& column) { n += column.loose(); });
    return n;
}

/// Folded edges, which bound no area, are skipped in the search downwards.
Surroundings SurroundingsSearch::find(std::uint32_t ring) const {
    assert(copies_.representative(ring) == ring);
    const RingEdge left_edge{ends_[ring].line, ring, ends_[ring].flat ? Windings{} : net_winding(ring),
                             place_in_order(ring, true)};
    const double x = left_edge.line.lo.x;
    RingEdge lowest = left_edge;
    lowest.order = std::numeric_limits<std::int64_t>::min();
    Surroundings result;
    edges_.for_columns_at(x, [&](const EdgeColumn& column) {
        result.winding += column.winding_below(x, left_edge);
        result.below_all += column.winding_below(x, lowest);
    });
    // Edges of the ring itself that run back along its lowest edge precede the lowest edge in the order.
    result.winding += count_equal(x, opposite(left_edge)) * left_edge.step;
    RingEdge from = left_edge;
    while (true) {
        const RingEdge* below = nullptr;
        edges_.for_columns_at(x, [&](const EdgeColumn& column) { column.raise(x, from, below); });
        if (below == nullptr)
            return result;
        if (below->ring != ring && count_equal(x, *below) > count_equal(x, opposite(*below))) {
            result.below = below;
            return result;
        }
        from = *below;
    }
}

} // namespace lamella
