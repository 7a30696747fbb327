#include "polygon/close_sides.hpp"

#include "polygon/chain_grid.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace lamella {

namespace {

/// Returns whether all of t lies on one side of the line of s, at a distance above `reach`.
bool beside(const Segment& s, const Segment& t, double reach) noexcept {
    const double dx = s.hi.x - s.lo.x;
    const double dy = s.hi.y - s.lo.y;
    const double lo = dx * (t.lo.y - s.lo.y) - dy * (t.lo.x - s.lo.x);
    const double hi = dx * (t.hi.y - s.lo.y) - dy * (t.hi.x - s.lo.x);
    return (lo > 0) == (hi > 0) &&
           std::min(std::abs(lo), std::abs(hi)) > reach * (std::abs(dx) + std::abs(dy));
}

class CloseSides {
  public:
    CloseSides(const Layer& layer, double reach)
        : layer_(layer), reach_(reach), chains_(layer), close_(layer.points.size(), false) {}

    std::vector<bool> run() && {
        for (std::uint32_t ring = 0; ring < layer_.rings; ++ring)
            compare_neighbours(layer_.offsets[ring], layer_.offsets[ring + 1]);
        const std::optional<ChainGrid> grid = ChainGrid::of(chains_, reach_);
        if (!chains_.all().empty() && !(grid && search(*grid)))
            close_.assign(close_.size(), true);
        return std::move(close_);
    }

  private:
    /// Compares consecutive sides of a chain. Other sides of one chain are close to each other only if the
    /// sides between them are short, and such sides are found here, too.
    void compare_neighbours(std::uint64_t begin, std::uint64_t end) {
        for (std::uint64_t i = begin; i < end; ++i) {
            const std::uint64_t next = i + 1 < end ? i + 1 : begin;
            const Point2& a = layer_.points[i];
            const Point2& b = layer_.points[next];
            const Point2& c = layer_.points[next + 1 < end ? next + 1 : begin];
            if (may_come_within(segment_between(a, b), {c, c}, reach_) ||
                may_come_within(segment_between(b, c), {a, a}, reach_))
                close_[i] = close_[next] = true;
        }
    }

    /// Returns false if the search would take too long.
    bool search(const ChainGrid& grid) {
        work_budget_ = 64 * (grid.pieces().size() + layer_.points.size()) + 4096;
        for (const Chain& piece : grid.pieces())
            if (ChainGrid::whole_ring(piece)) {
                const std::span<const Chain> chains = grid.chains(piece);
                for (std::size_t a = 0; a < chains.size(); ++a)
                    for (std::size_t b = a + 1; b < chains.size(); ++b)
                        compare(chains[a], chains[b]);
            }
        const Grid& cells = grid.cells();
        for (std::size_t i = 0; i < cells.cells(); ++i) {
            const std::span<const std::uint32_t> here = cells.in_cell(i);
            if (!take(here.size() * here.size() / 16))
                return false;
            for (std::size_t a = 0; a < here.size(); ++a)
                for (std::size_t b = a + 1; b < here.size(); ++b) {
                    const Box2& s = grid.box(here[a]);
                    const Box2& t = grid.box(here[b]);
                    // Boxes may meet in many cells, but the pair is compared in only one of them.
                    if (s.meets(t) && i == cells.cell({std::max(s.x0, t.x0), std::max(s.y0, t.y0)}))
                        for (const Chain& chain : grid.chains(grid.pieces()[here[a]]))
                            for (const Chain& other : grid.chains(grid.pieces()[here[b]]))
                                compare(chain, other);
                }
        }
        return work_budget_ > 0;
    }

    bool take(std::uint64_t steps) noexcept {
        work_budget_ -= std::min(work_budget_, steps);
        return work_budget_ > 0;
    }

    void compare(const Chain& a, const Chain& b) { compare(a, 0, a.segments, b, 0, b.segments); }

    /// Compares the segments [a0, a1) of chain a with the segments [b0, b1) of b.
    void compare(const Chain& a, std::uint32_t a0, std::uint32_t a1, const Chain& b, std::uint32_t b0,
                 std::uint32_t b1) {
        if (!take(1) || !Box2::of(chains_.point(a, a0), chains_.point(a, a1))
                             .grown(reach_)
                             .meets(Box2::of(chains_.point(b, b0), chains_.point(b, b1))))
            return;
        if (a1 - a0 == 1 && b1 - b0 == 1) {
            const std::uint64_t i = a.first + a0;
            const std::uint64_t j = b.first + b0;
            if (!(close_[i] && close_[j]) && following(a.ring, i) != j && following(b.ring, j) != i &&
                may_come_within(segment_between(chains_.point(a, a0), chains_.point(a, a1)),
                                segment_between(chains_.point(b, b0), chains_.point(b, b1)), reach_))
                close_[i] = close_[j] = true;
        } else if (a1 - a0 >= b1 - b0) {
            const std::uint32_t middle = a0 + (a1 - a0) / 2;
            compare(a, a0, middle, b, b0, b1);
            compare(a, middle, a1, b, b0, b1);
        } else {
            const std::uint32_t middle = b0 + (b1 - b0) / 2;
            compare(a, a0, a1, b, b0, middle);
            compare(a, a0, a1, b, middle, b1);
        }
    }

    [[nodiscard]] std::uint64_t following(std::uint32_t ring, std::uint64_t i) const noexcept {
        return i + 1 == layer_.offsets[ring + 1] ? layer_.offsets[ring] : i + 1;
    }

    const Layer& layer_;
    double reach_;
    MonotoneChains chains_;
    std::vector<bool> close_;
    std::uint64_t work_budget_ = 0;
};

} // namespace

bool may_come_within(const Segment& s, const Segment& t, double reach) noexcept {
    return Box2::of(s.lo, s.hi).grown(reach).meets(Box2::of(t.lo, t.hi)) && !beside(s, t, reach) &&
           !beside(t, s, reach);
}

std::vector<bool> close_sides(const Layer& rings, double reach) {
    return CloseSides(rings, reach).run();
}

} // namespace lamella
