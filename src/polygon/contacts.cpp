#include "polygon/contacts.hpp"

#include "lamella/core/error.hpp"

#include "polygon/orientation.hpp"
#include "polygon/segment_sweep.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <numeric>
#include <set>
#include <span>
#include <tuple>

namespace lamella {

namespace {

/// Disjoint sets of rings. A set is marked when a contact is found in it.
class Groups {
  public:
    explicit Groups(std::size_t rings) : parent_(rings), marked_(rings, false) {
        std::iota(parent_.begin(), parent_.end(), 0U);
    }
    [[nodiscard]] std::uint32_t find(std::uint32_t i) noexcept {
        while (parent_[i] != i)
            i = parent_[i] = parent_[parent_[i]];
        return i;
    }
    /// Returns whether a contact between two rings would change the sets or marks.
    [[nodiscard]] bool open(std::uint32_t i, std::uint32_t j) noexcept {
        return i == j ? !marked_[find(i)] : find(i) != find(j);
    }
    /// Returns the number of calls of `connect`.
    [[nodiscard]] std::uint64_t merges() const noexcept { return merges_; }
    void connect(std::uint32_t i, std::uint32_t j) noexcept {
        ++merges_;
        i = find(i);
        j = find(j);
        parent_[std::max(i, j)] = std::min(i, j);
        marked_[std::min(i, j)] = true;
    }
    [[nodiscard]] Contacts contacts() {
        Contacts result;
        result.group.assign(parent_.size(), Contacts::none);
        for (std::uint32_t i = 0; i < parent_.size(); ++i) {
            const std::uint32_t first = find(i);
            assert(first <= i);
            if (marked_[first])
                result.group[i] = first == i ? result.groups++ : result.group[first];
        }
        return result;
    }

  private:
    std::vector<std::uint32_t> parent_; // the smallest number of a set is its root
    std::vector<bool> marked_;
    std::uint64_t merges_ = 0;
};

/// Puts all rings into groups that are connected by boxes that meet.
void group_by_boxes(const MonotoneChains& chains, Groups& groups) {
    std::vector<std::uint32_t> order;
    for (std::uint32_t ring = 0; ring < chains.rings(); ++ring)
        if (!chains.of_ring(ring).empty())
            order.push_back(ring);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
        return std::tie(chains.box(a).x0, a) < std::tie(chains.box(b).x0, b);
    });
    // Groups at the x of the sweep, by their intervals of y. The intervals are disjoint, because otherwise
    // the groups would be joined.
    struct Open {
        double y0;
        double y1;
        double x1;
        std::uint32_t ring;
    };
    const auto by_y = [](const Open& a, const Open& b) {
        return a.y1 < b.y0;
    };
    std::set<Open, decltype(by_y)> open(by_y);
    for (const std::uint32_t ring : order) {
        Open here{chains.box(ring).y0, chains.box(ring).y1, chains.box(ring).x1, ring};
        groups.connect(ring, ring);
        for (auto other = open.find(here); other != open.end(); other = open.find(here)) {
            if (other->x1 >= chains.box(ring).x0) {
                groups.connect(ring, other->ring);
                here = {std::min(here.y0, other->y0), std::max(here.y1, other->y1),
                        std::max(here.x1, other->x1), ring};
            }
            open.erase(other);
        }
        open.insert(here);
    }
}

class ContactSearch {
  public:
    ContactSearch(const Layer& layer, const MonotoneChains& chains, const LayerBudget& budget)
        : layer_(layer), all_(chains), budget_(budget), groups_(layer.rings) {}

    Contacts run(const std::optional<ChainGrid>& grid) && {
        const bool searched = grid && search(*grid);
        if (!searched && !all_.all().empty() && (found_ || !free_of_contacts()))
            group_by_boxes(all_, groups_);
        return groups_.contacts();
    }

  private:
    /// Returns false if the search would take too long.
    bool search(const ChainGrid& grid) {
        // Long adjacent chains, such as those of a ring and its offset, are traversed once.
        work_budget_ = 64 * (grid.pieces().size() + all_.all().size()) + 8 * layer_.points.size() + 4096;
        for (const Chain& piece : grid.pieces())
            if (ChainGrid::whole_ring(piece))
                look_into(piece.ring);
        const Grid& cells = grid.cells();
        for (std::size_t i = 0; i < cells.cells(); ++i) {
            const std::span<const std::uint32_t> here = cells.in_cell(i);
            if (no_merges_among(grid, here))
                continue;
            const std::uint64_t pairs = here.size() * here.size() / 16;
            if (work_budget_ < pairs)
                return false;
            work_budget_ -= pairs;
            std::uint64_t merges = groups_.merges();
            for (std::size_t a = 0; a < here.size(); ++a) {
                if (groups_.merges() != merges && no_merges_among(grid, here))
                    break;
                merges = groups_.merges();
                for (std::size_t b = a + 1; b < here.size(); ++b) {
                    const Box2& s = grid.box(here[a]);
                    const Box2& t = grid.box(here[b]);
                    // Boxes may meet in many cells, but the pair is examined in only one of them.
                    if (s.meets(t) && i == cells.cell({std::max(s.x0, t.x0), std::max(s.y0, t.y0)}))
                        look_into(grid, here[a], here[b]);
                }
            }
        }
        return work_budget_ > 0;
    }

    /// Returns whether all pieces are already in one marked group, such as the spikes of a star.
    [[nodiscard]] bool no_merges_among(const ChainGrid& grid, std::span<const std::uint32_t> pieces) {
        return std::none_of(pieces.begin(), pieces.end(), [&](std::uint32_t i) {
            return groups_.open(grid.pieces()[i].ring, grid.pieces()[pieces.front()].ring) ||
                   groups_.open(grid.pieces()[i].ring, grid.pieces()[i].ring);
        });
    }

    /// Examines all pairs of chains of a ring of few chains.
    void look_into(std::uint32_t ring) {
        const std::span<const Chain> chains = all_.of_ring(ring);
        for (std::size_t a = 0; a < chains.size(); ++a)
            for (std::size_t b = a + 1; b < chains.size(); ++b)
                look_into(chains[a], chains[b]);
    }

    /// Examines two pieces; a must come before b.
    void look_into(const ChainGrid& grid, std::uint32_t a, std::uint32_t b) {
        const std::span<const Chain> chains = grid.chains(grid.pieces()[a]);
        const std::span<const Chain> others = grid.chains(grid.pieces()[b]);
        work_budget_ -= std::min<std::uint64_t>(work_budget_, chains.size() * others.size() / 16);
        for (const Chain& s : chains) {
            if (work_budget_ == 0)
                return;
            if (s.box().meets(grid.box(b)))
                for (const Chain& t : others)
                    look_into(s, t);
        }
    }

    /// Examines two chains; a must come before b in the layer.
    void look_into(const Chain& a, const Chain& b) {
        if (work_budget_ == 0 || !groups_.open(a.ring, b.ring) || !a.box().meets(b.box()))
            return;
        if (continues(b, a) && !continues(a, b) ? in_contact(b, a) : in_contact(a, b)) {
            groups_.connect(a.ring, b.ring);
            found_ = true;
        }
    }

    bool in_contact(const Chain& a, const Chain& b) {
        if (continues(a, b)) {
            // One chain begins where the other ends. If both have the same directions, they meet nowhere
            // else. If only the x-direction changes, one lies above the common point and the other below it,
            // except for horizontal edges next to the point, which may coincide (a fold). The same holds for
            // y.
            const unsigned ways = a.ways | b.ways;
            if (!way::turns_in_y(ways))
                return way::turns_in_x(ways) && last_but_one(a).y == a.back.y && second(b).y == b.front.y;
            if (!way::turns_in_x(ways))
                return last_but_one(a).x == a.back.x && second(b).x == b.front.x;
        }
        return in_contact(a, 0, a.segments, b, 0, b.segments);
    }

    /// Returns whether b begins where a ends.
    [[nodiscard]] bool continues(const Chain& a, const Chain& b) const noexcept {
        const std::uint64_t end = a.first + a.segments;
        return a.ring == b.ring &&
               (end == layer_.offsets[a.ring + 1] ? layer_.offsets[a.ring] : end) == b.first;
    }

    /// Return the second point of a chain, and the last but one, ignoring repeated points.
    [[nodiscard]] const Point2& second(const Chain& chain) const noexcept {
        std::uint32_t i = 1;
        while (i < chain.segments && all_.point(chain, i) == chain.front)
            ++i;
        return all_.point(chain, i);
    }
    [[nodiscard]] const Point2& last_but_one(const Chain& chain) const noexcept {
        std::uint32_t i = chain.segments - 1;
        while (i > 0 && all_.point(chain, i) == chain.back)
            --i;
        return all_.point(chain, i);
    }

    /// Returns whether the segments [a0, a1) of chain a are in contact with the segments [b0, b1) of b.
    bool in_contact(const Chain& a, std::uint32_t a0, std::uint32_t a1, const Chain& b, std::uint32_t b0,
                    std::uint32_t b1) {
        work_budget_ -= work_budget_ > 0 ? 1 : 0;
        if (!Box2::of(all_.point(a, a0), all_.point(a, a1))
                 .meets(Box2::of(all_.point(b, b0), all_.point(b, b1))))
            return false;
        if (a1 - a0 == 1 && b1 - b0 == 1)
            return in_contact(a.ring, static_cast<std::uint32_t>(a.first + a0), b.ring,
                              static_cast<std::uint32_t>(b.first + b0));
        if (a1 - a0 >= b1 - b0) {
            const std::uint32_t middle = a0 + (a1 - a0) / 2;
            return in_contact(a, a0, middle, b, b0, b1) || in_contact(a, middle, a1, b, b0, b1);
        }
        const std::uint32_t middle = b0 + (b1 - b0) / 2;
        return in_contact(a, a0, a1, b, b0, middle) || in_contact(a, a0, a1, b, middle, b1);
    }

    /// Returns the same for the segments that begin at the points with these indices.
    [[nodiscard]] bool in_contact(std::uint32_t ring_a, std::uint32_t i, std::uint32_t ring_b,
                                  std::uint32_t j) const {
        const Point2& a0 = layer_.points[i];
        const Point2& a1 = layer_.points[following(ring_a, i)];
        const Point2& b0 = layer_.points[j];
        const Point2& b1 = layer_.points[following(ring_b, j)];
        if (a0 == a1 || b0 == b1)
            return false; // its point belongs to the adjacent segments, too
        if (ring_a == ring_b) {
            if (follows(ring_a, i, j))
                return folds(a0, a1, b1);
            if (follows(ring_a, j, i))
                return folds(b0, b1, a1);
        }
        return meet(segment_between(a0, a1), segment_between(b0, b1));
    }

    [[nodiscard]] std::uint32_t following(std::uint32_t ring, std::uint32_t i) const noexcept {
        return static_cast<std::uint32_t>(i + 1 == layer_.offsets[ring + 1] ? layer_.offsets[ring] : i + 1);
    }

    /// Returns whether segment j follows segment i, ignoring repeated points.
    [[nodiscard]] bool follows(std::uint32_t ring, std::uint32_t i, std::uint32_t j) const noexcept {
        const Point2& end = layer_.points[following(ring, i)];
        for (std::uint32_t next = following(ring, i); next != i; next = following(ring, next)) {
            if (next == j)
                return true;
            if (layer_.points[following(ring, next)] != end)
                return false;
        }
        return false;
    }

    /// Returns whether the path from a over b to c doubles back on itself.
    static bool folds(const Point2& a, const Point2& b, const Point2& c) noexcept {
        return orientation(a, b, c) == 0 && (a < b) == (c < b);
    }

    /// Returns whether no segments are in contact. Tests only neighbours on the sweep line, which suffices:
    /// if any two segments are in contact, so are two neighbours.
    [[nodiscard]] bool free_of_contacts() const {
        std::vector<Segment> segments;
        struct Origin {
            std::uint32_t ring;
            std::uint32_t first;
        };
        std::vector<Origin> origins;
        for (std::uint32_t ring = 0; ring < layer_.rings; ++ring)
            for (auto i = static_cast<std::uint32_t>(layer_.offsets[ring]); i < layer_.offsets[ring + 1];
                 ++i) {
                const Point2& a = layer_.points[i];
                const Point2& b = layer_.points[following(ring, i)];
                if (a == b)
                    continue;
                segments.push_back(segment_between(a, b));
                origins.push_back({ring, i});
            }
        SweepStatus status(segments);
        const auto neighbours_in_contact = [&](std::uint32_t lower, std::uint32_t upper) {
            return lower != SweepStatus::none && upper != SweepStatus::none &&
                   in_contact(origins[lower].ring, origins[lower].first, origins[upper].ring,
                              origins[upper].first);
        };
        // Beginnings come first, because a segment that begins where another one ends is in contact with it.
        for (const auto& [at, i, begins] : sweep_events(segments, SweepOrder::begins_first)) {
            budget_.check();
            if (begins) {
                status.insert(i);
                if (neighbours_in_contact(status.below(i), i) || neighbours_in_contact(i, status.above(i)))
                    return false;
            } else {
                const std::uint32_t below = status.below(i);
                const std::uint32_t above = status.above(i);
                status.erase(i);
                if (neighbours_in_contact(below, above))
                    return false;
            }
        }
        assert(status.empty());
        return true;
    }

    const Layer& layer_;
    const MonotoneChains& all_;
    const LayerBudget& budget_;
    Groups groups_;
    std::uint64_t work_budget_ = 0; // steps until the grid is abandoned
    bool found_ = false;
};

} // namespace

Contacts find_contacts(const Layer& layer, const MonotoneChains& chains, const std::optional<ChainGrid>& grid,
                       const LayerBudget& budget) {
    if (layer.points.size() >= Contacts::none)
        throw Error(ErrorKind::limit,
                    "a layer has more than 4294967294 points; contacts are found in smaller ones");
    return ContactSearch(layer, chains, budget).run(grid);
}

} // namespace lamella
