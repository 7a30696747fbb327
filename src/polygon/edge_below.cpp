#include "polygon/edge_below.hpp"

#include "polygon/orientation.hpp"

#include <algorithm>
#include <cassert>

namespace lamella {

namespace {

/// Returns the edge of a chain over x and slightly beyond. The chain must reach over x.
Segment edge_over(double x, const MonotoneChains& chains, const Chain& chain) {
    const bool rightwards = (chain.ways & way::right) != 0;
    std::uint32_t low = 0; // point `low` is on the near side of x, point `high` on the far side
    std::uint32_t high = chain.segments;
    while (high - low > 1) {
        const std::uint32_t middle = low + (high - low) / 2;
        const bool beyond = chains.point(chain, middle).x > x;
        (beyond == rightwards ? high : low) = middle;
    }
    const Point2& a = chains.point(chain, low);
    const Point2& b = chains.point(chain, high);
    const Segment edge = rightwards ? Segment{a, b} : Segment{b, a};
    assert(edge.lo.x <= x && x < edge.hi.x);
    return edge;
}

} // namespace

EdgeBelow edge_below(const Point2& p, std::uint32_t own, const MonotoneChains& chains, const ChainGrid& grid,
                     const Contacts& contacts) {
    EdgeBelow found;
    Segment highest{};
    const auto reaches = [&p](const Box2& box) {
        return box.x0 <= p.x && p.x < box.x1 && box.y0 <= p.y;
    };
    const Grid& cells = grid.cells();
    const std::size_t column = cells.column(p.x);
    for (std::size_t row = cells.row(p.y) + 1; row-- > 0;) {
        for (const std::uint32_t i : cells.in_cell(cells.cell_at(column, row))) {
            if (!reaches(grid.box(i)) || grid.pieces()[i].ring == own)
                continue;
            for (const Chain& chain : grid.chains(grid.pieces()[i])) {
                if (!reaches(chain.box()))
                    continue;
                const Segment edge = edge_over(p.x, chains, chain);
                if (side(edge, p) <= 0)
                    continue;
                if (contacts.group[chain.ring] != Contacts::none)
                    return {.sure = false};
                if (found.ring == Nesting::none || compare_right_of(p.x, edge, highest) > 0) {
                    highest = edge;
                    found = {chain.ring, (chain.ways & way::right) != 0};
                }
            }
        }
        // Edges that were not yet visited lie entirely in lower rows.
        if (found.ring != Nesting::none && cells.row(std::min(highest.lo.y, highest.hi.y)) >= row)
            break;
    }
    return found;
}

} // namespace lamella
