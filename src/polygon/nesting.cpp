#include "lamella/polygon/nesting.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"

#include "polygon/edge_below.hpp"
#include "polygon/known_nesting.hpp"
#include "polygon/left_end.hpp"
#include "polygon/ring_copies.hpp"
#include "polygon/ring_placement.hpp"
#include "polygon/surroundings.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Takes the rings from left to right and looks at what lies below the left end of each.
class NestingSearch {
  public:
    /// `turns`: what each ring adds to the windings. `apart`: no two rings have a point in common, nor has
    /// one with itself.
    NestingSearch(const Layer& layer, const MonotoneChains& chains, std::span<const Windings> turns,
                  bool apart)
        : layer_(layer), chains_(chains), turns_(turns), apart_(apart), ends_(ends_of(layer, chains)),
          copies_(layer, ends_, apart), below_(layer.rings), placement_(ends_, copies_, turns) {
        for (std::uint32_t i = 0; i < ends_.size(); ++i)
            if (layer.contour(i).empty())
                placement_.place_empty(i);
            else if (copies_.representative(i) == i)
                order_.push_back(i);
    }

    /// `grid`: null where there is none.
    WoundNesting run(const ChainGrid* grid) && {
        order_by_area();
        order_from_left_to_right();
        if (apart_ && grid != nullptr && !grid->crowded() &&
            std::none_of(ends_.begin(), ends_.end(), std::mem_fn(&LeftEnd::flat)))
            place_apart(*grid);
        else if (!order_.empty())
            place_any();
        WoundNesting result = std::move(placement_).result();
        result.below = std::move(below_);
        return result;
    }

  private:
    void place_any() {
        const SurroundingsSearch surroundings(chains_, ends_, copies_, turns_, order_, by_area_);
        for (const std::uint32_t ring : order_) {
            const Surroundings around = surroundings.find(ring);
            placement_.place(ring, parent_of(around), around.winding);
            for (std::uint32_t copy = ring; copy != Nesting::none; copy = copies_.next(copy))
                below_[copy] = around.below_all;
        }
    }

    [[nodiscard]] std::uint32_t parent_of(const Surroundings& around) const noexcept {
        if (around.below == nullptr)
            return Nesting::none;
        const std::uint32_t below = around.below->ring;
        return around.below->order >= 0 ? placement_.innermost(below) : placement_.outside(below);
    }

    /// The next edge below a left end is enough to know: the ring is inside of that edge's ring, or beside
    /// it.
    void place_apart(const ChainGrid& grid) {
        for (const std::uint32_t ring : order_) {
            const Point2& left = ends_[ring].line.lo;
            const std::optional<EdgeBelow> below =
                grid.surrounded(left, ring) ? edge_below(left, ring, chains_, grid) : std::nullopt;
            std::uint32_t parent = Nesting::none;
            if (below)
                parent = below->rightwards == ends_[below->ring].rightwards ? below->ring
                                                                            : placement_.outside(below->ring);
            const Windings winding = parent == Nesting::none ? Windings{} : placement_.winding_inside(parent);
            assert(!below || below->ring == parent || placement_.winding(below->ring) == winding);
            placement_.place(ring, parent, winding);
            below_[ring] = winding;
        }
    }

    static std::vector<LeftEnd> ends_of(const Layer& layer, const MonotoneChains& chains) {
        std::vector<LeftEnd> ends(layer.rings);
        for (std::size_t i = 0; i < layer.rings; ++i)
            if (!layer.contour(i).empty())
                ends[i] = left_end(layer, chains, i);
        return ends;
    }

    /// Areas only count where edges coincide, and take a look at all points.
    void order_by_area() {
        by_area_.resize(ends_.size());
        if (apart_) {
            std::iota(by_area_.begin(), by_area_.end(), 0U);
            return;
        }
        std::vector<double> area(ends_.size());
        for (const std::uint32_t ring : order_)
            area[ring] = ends_[ring].flat ? 0 : std::abs(ring_area(layer_.contour(ring)));
        std::vector<std::uint32_t> largest_first = order_;
        std::sort(largest_first.begin(), largest_first.end(), [&](std::uint32_t a, std::uint32_t b) {
            return area[a] != area[b] ? area[a] > area[b] : a < b;
        });
        for (std::uint32_t i = 0; i < largest_first.size(); ++i)
            by_area_[largest_first[i]] = i;
    }

    /// So that what lies below a left end comes before it.
    void order_from_left_to_right() {
        const auto before = [&](std::uint32_t a, std::uint32_t b) {
            const Segment& s = ends_[a].line;
            const Segment& t = ends_[b].line;
            if (s.lo != t.lo)
                return s.lo < t.lo;
            const int by_slope = compare_right_of(s.lo.x, s, t);
            return by_slope != 0 ? by_slope < 0 : by_area_[a] < by_area_[b];
        };
        if (!std::is_sorted(order_.begin(), order_.end(), before)) // rings in normal form all but are
            std::sort(order_.begin(), order_.end(), before);
    }

    const Layer& layer_;
    const MonotoneChains& chains_;
    std::span<const Windings> turns_;
    bool apart_;
    std::vector<LeftEnd> ends_;
    RingCopies copies_;
    std::vector<std::uint32_t> order_;   ///< the representatives
    std::vector<std::uint32_t> by_area_; ///< of representatives: 0 for the largest
    std::vector<Windings> below_;
    RingPlacement placement_;
};

void check_size(const Layer& layer) {
    if (layer.rings >= Nesting::none)
        throw Error(ErrorKind::limit,
                    "a layer has more than 4294967294 rings; nesting is found for fewer of them");
}

} // namespace

Nesting nesting(const Layer& layer) {
    check_size(layer);
    const MonotoneChains chains(layer);
    const std::optional<ChainGrid> grid = ChainGrid::of(chains);
    const std::vector<Windings> turns(layer.rings, Windings{1, 0});
    return nesting(layer, chains, grid ? &*grid : nullptr,
                   find_contacts(layer, chains, grid ? &*grid : nullptr), turns)
        .nesting;
}

WoundNesting nesting(const Layer& layer, const MonotoneChains& chains, const ChainGrid* grid,
                     const Contacts& contacts, std::span<const Windings> turns) {
    check_size(layer);
    return NestingSearch(layer, chains, turns, contacts.groups == 0).run(grid);
}

std::vector<Polygon> polygons(const Nesting& nesting) {
    std::vector<Polygon> result;
    std::vector<std::size_t> place(nesting.rings());
    for (std::uint32_t i = 0; i < nesting.rings(); ++i)
        if (nesting.body[i] == i) {
            place[i] = result.size();
            result.push_back({i, {}});
        }
    for (std::uint32_t i = 0; i < nesting.rings(); ++i)
        if (nesting.body[i] != i && nesting.body[i] != Nesting::none)
            result[place[nesting.body[i]]].holes.push_back(i);
    return result;
}

} // namespace lamella
