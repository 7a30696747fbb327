#include "lamella/polygon/nesting.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "polygon/crossing_pairs.hpp"
#include "polygon/edge_below.hpp"
#include "polygon/known_nesting.hpp"
#include "polygon/left_end.hpp"
#include "polygon/ring_copies.hpp"
#include "polygon/ring_placement.hpp"
#include "polygon/surroundings.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Visits the rings from left to right and examines the edges below the left end of each.
class NestingSearch {
  public:
    /// `turns` is the contribution of each ring to the winding numbers.
    NestingSearch(const Layer& layer, const MonotoneChains& chains, std::span<const Windings> turns,
                  const Contacts& contacts)
        : layer_(layer), chains_(chains), turns_(turns), contacts_(contacts), ends_(ends_of(layer, chains)),
          copies_(layer, ends_, contacts), below_(layer.rings), placement_(ends_, copies_, turns) {
        for (std::uint32_t i = 0; i < ends_.size(); ++i)
            if (layer.contour(i).empty())
                placement_.place_empty(i);
            else if (copies_.representative(i) == i)
                order_.push_back(i);
    }

    NestingWithWindings run(const std::optional<ChainGrid>& grid, const LayerBudget& budget,
                            const CrossingLimit& most) && {
        order_by_area();
        order_from_left_to_right();
        const bool by_grid = grid && !grid->full();
        std::vector<EdgeBelow> edges;
        std::vector<std::uint32_t> open; // rings for which one edge does not suffice
        edges.reserve(order_.size());
        for (const std::uint32_t ring : order_) {
            budget.check();
            edges.push_back(by_grid ? edge_below_end(ring, *grid) : EdgeBelow{.sure = false});
            if (!edges.back().sure)
                open.push_back(ring);
        }
        std::optional<SurroundingsSearch> surroundings;
        if (!open.empty())
            surroundings.emplace(chains_, ends_, copies_, turns_, order_, by_area_, open);
        // Edges that cross have no order, so the search among them is quadratic. Layers whose contours cross
        // too often are refused.
        constexpr std::uint64_t half_a_second = std::uint64_t{1} << 22;
        std::uint64_t crossing = 0;
        for (const std::uint32_t ring : open)
            crossing += surroundings->crossing_edges_at(ring);
        if (crossing > half_a_second)
            check_crossings(layer_, budget, most);
        for (std::size_t i = 0; i < order_.size(); ++i) {
            budget.check();
            if (edges[i].sure)
                place_over(edges[i], order_[i]);
            else
                place_amid(surroundings->find(order_[i]), order_[i]);
        }
        NestingWithWindings result = std::move(placement_).result();
        result.below = std::move(below_);
        return result;
    }

  private:
    [[nodiscard]] bool in_contact(std::uint32_t ring) const noexcept {
        return contacts_.group[ring] != Contacts::none ||
               ends_[ring].flat; // a flat ring may be a single point
    }

    /// Returns the next edge below the left end of a ring without contacts. This edge determines the nesting,
    /// unless it may belong to a ring in contact.
    [[nodiscard]] EdgeBelow edge_below_end(std::uint32_t ring, const ChainGrid& grid) const {
        if (in_contact(ring))
            return {.sure = false};
        const Point2& left = ends_[ring].line.lo;
        // If rings cross, the parent is the first one in the downward direction, even if its box lies below.
        if (contacts_.groups == 0 && !grid.surrounded(left, ring))
            return {};
        return edge_below(left, ring, chains_, grid, contacts_);
    }

    /// Places a ring inside of the edge's ring, or next to it.
    void place_over(const EdgeBelow& edge, std::uint32_t ring) {
        std::uint32_t parent = Nesting::none;
        Windings winding;
        if (edge.ring != Nesting::none) {
            const bool inside = edge.rightwards == ends_[edge.ring].rightwards;
            parent = inside ? edge.ring : placement_.outside(edge.ring);
            // The winding number inside of the parent is not used, because it is not constant if the parent
            // crosses itself.
            winding = inside ? placement_.winding_inside(edge.ring) : placement_.winding(edge.ring);
        }
        placement_.place(ring, parent, winding);
        below_[ring] = winding;
    }

    void place_amid(const Surroundings& around, std::uint32_t ring) {
        placement_.place(ring, parent_of(around), around.winding);
        for (std::uint32_t copy = ring; copy != Nesting::none; copy = copies_.next(copy))
            below_[copy] = around.below_all;
    }

    [[nodiscard]] std::uint32_t parent_of(const Surroundings& around) const noexcept {
        if (around.below == nullptr)
            return Nesting::none;
        const std::uint32_t below = around.below->ring;
        return around.below->order >= 0 ? placement_.innermost(below) : placement_.outside(below);
    }

    static std::vector<LeftEnd> ends_of(const Layer& layer, const MonotoneChains& chains) {
        std::vector<LeftEnd> ends(layer.rings);
        for (std::size_t i = 0; i < layer.rings; ++i)
            if (!layer.contour(i).empty())
                ends[i] = left_end(layer, chains, i);
        return ends;
    }

    /// Ranks rings in contact by area, because areas matter only where edges coincide.
    void order_by_area() {
        std::vector<double> area(ends_.size());
        std::vector<std::uint32_t> largest_first;
        for (const std::uint32_t ring : order_)
            if (in_contact(ring)) {
                area[ring] = ends_[ring].flat ? 0 : std::abs(ring_area(layer_.contour(ring)));
                largest_first.push_back(ring);
            }
        std::sort(largest_first.begin(), largest_first.end(), [&](std::uint32_t a, std::uint32_t b) {
            return area[a] != area[b] ? area[a] > area[b] : a < b;
        });
        by_area_.resize(ends_.size());
        for (std::uint32_t i = 0; i < largest_first.size(); ++i)
            by_area_[largest_first[i]] = i + 1;
    }

    /// Orders rings so that rings with edges below a left end come before the ring of this left end.
    void order_from_left_to_right() {
        const auto before = [&](std::uint32_t a, std::uint32_t b) {
            const Segment& s = ends_[a].line;
            const Segment& t = ends_[b].line;
            if (s.lo != t.lo)
                return s.lo < t.lo;
            const int by_slope = compare_right_of(s.lo.x, s, t);
            return by_slope != 0 ? by_slope < 0 : by_area_[a] < by_area_[b];
        };
        if (!std::is_sorted(order_.begin(), order_.end(), before)) // rings in normal form are nearly sorted
            std::sort(order_.begin(), order_.end(), before);
    }

    const Layer& layer_;
    const MonotoneChains& chains_;
    std::span<const Windings> turns_;
    const Contacts& contacts_;
    std::vector<LeftEnd> ends_;
    RingCopies copies_;
    std::vector<std::uint32_t> order_;   ///< the representatives
    std::vector<std::uint32_t> by_area_; ///< 0 for rings without contacts, 1 for the largest of the others
    std::vector<Windings> below_;
    RingPlacement placement_;
};

void check_size(const Layer& layer) {
    if (layer.rings >= Nesting::none)
        throw Error(ErrorKind::limit,
                    "a layer has more than 4294967294 rings; nesting is found for fewer of them");
}

} // namespace

Nesting nesting(const Layer& layer, const LayerLimits& limits) {
    check_size(layer);
    const LayerBudget budget(limits, layer.index, layer.z);
    const MonotoneChains chains(layer);
    const std::optional<ChainGrid> grid = ChainGrid::of(chains);
    const std::vector<Windings> turns(layer.rings, Windings{1, 0});
    return nesting(layer, chains, grid, find_contacts(layer, chains, grid, budget), turns, budget).nesting;
}

NestingWithWindings nesting(const Layer& layer, const MonotoneChains& chains,
                            const std::optional<ChainGrid>& grid, const Contacts& contacts,
                            std::span<const Windings> turns, const LayerBudget& budget,
                            const CrossingLimit& most) {
    check_size(layer);
    return NestingSearch(layer, chains, turns, contacts).run(grid, budget, most);
}

std::vector<Polygon> polygons(const Nesting& nesting) {
    std::vector<Polygon> result;
    std::vector<std::size_t> position(nesting.rings());
    for (std::uint32_t i = 0; i < nesting.rings(); ++i)
        if (nesting.body[i] == i) {
            position[i] = result.size();
            result.push_back({i, {}});
        }
    for (std::uint32_t i = 0; i < nesting.rings(); ++i)
        if (nesting.body[i] != i && nesting.body[i] != Nesting::none)
            result[position[nesting.body[i]]].holes.push_back(i);
    return result;
}

} // namespace lamella
