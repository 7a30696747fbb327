#include "lamella/polygon/nesting.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "polygon/edge_below.hpp"
#include "polygon/known_nesting.hpp"
#include "polygon/monotone_chains.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// An edge of a ring that is not vertical.
struct Edge {
    Segment line;
    std::uint32_t ring = 0; ///< a representative, see `Copies`
    /// How the winding number changes from below to above.
    std::int32_t step = 0;
    /// Orders edges that coincide, as if they lay upon one another: rings that end at the edge first, the
    /// inner ones before those around them, then rings that begin there, the outer ones first. Not negative
    /// where the ring's inside is above.
    std::int64_t order = 0;
};

/// Where a ring begins, from left to right: the lowest of its edges at its left end.
struct LeftEnd {
    Segment line;
    bool rightwards = true; ///< the direction of that edge: counter-clockwise rings run rightwards there
    bool flat = false;
    Point2 smallest; ///< of the ring's points
};

/// How `edge` lies to the line of `probe` just to the right of probe.lo, where both exist: -1 below, 0 on it,
/// 1 above.
int compare_at(const Segment& edge, const Segment& probe) noexcept {
    const int by_place = -side(edge, probe.lo);
    return by_place != 0 ? by_place : -side(edge, probe.hi);
}

/// Whether all points lie on the line through the smallest and the largest of them.
bool collinear(std::span<const Point2> ring) noexcept {
    const auto ends = std::minmax_element(ring.begin(), ring.end());
    return std::all_of(ring.begin(), ring.end(),
                       [&](const Point2& p) { return orientation(*ends.first, *ends.second, p) == 0; });
}

/// Of ring i, which has points. Only those of its points are looked at that are as far to the left as any,
/// and the edges that begin there.
LeftEnd left_end(const Layer& layer, const MonotoneChains& chains, std::size_t i) {
    const std::span<const Point2> ring = layer.contour(i);
    LeftEnd result;
    result.smallest = ring.front();
    bool found = false;
    bool folded = false; // an edge that runs there and back says nothing about the direction of the ring
    const auto look_at = [&](const Segment& line, bool rightwards) {
        const int order = !found                          ? -1
                          : line.lo.y != result.line.lo.y ? (line.lo.y < result.line.lo.y ? -1 : 1)
                                                          : compare_at(line, result.line);
        if (order < 0) {
            result.line = line;
            result.rightwards = rightwards;
            folded = false;
        } else if (order == 0 && rightwards != result.rightwards) {
            folded = true;
        }
        found = true;
    };
    const double left = chains.of_ring(i).empty() ? ring.front().x : chains.box(i).x0;
    for (const Chain& chain : chains.of_ring(i)) {
        const bool rightwards = chain.front.x == left;
        if (!rightwards && chain.back.x != left)
            continue;
        // From the end that is at the left, along what is vertical there, to the first point beyond.
        for (std::uint32_t k = 0; k <= chain.segments; ++k) {
            const Point2& p = chains.point(chain, rightwards ? k : chain.segments - k);
            if (p.x > left) {
                look_at({chains.point(chain, rightwards ? k - 1 : chain.segments - k + 1), p}, rightwards);
                break;
            }
            result.smallest = std::min(result.smallest, p);
        }
    }
    if (!found) {
        result.flat = true;
        result.line = {result.smallest, {std::numeric_limits<double>::max(), result.smallest.y}};
    } else if (folded) {
        result.rightwards = ring_area(ring) > 0;
        result.flat = collinear(ring);
    }
    return result;
}

/// A ring's corners from its smallest point on, in the direction in which the second one is smaller: the same
/// for all rings that bound the same place, in either direction.
std::vector<Point2> corners(std::span<const Point2> ring) {
    const std::size_t n = ring.size();
    const std::size_t start = smallest_rotation(ring);
    const auto at = [&](std::size_t i) -> const Point2& {
        return ring[(start + i) % n];
    };
    std::vector<Point2> result{at(0)};
    for (std::size_t i = 1; i < n; ++i)
        if (orientation(result.back(), at(i), at(i + 1)) != 0)
            result.push_back(at(i));
    if (result.size() > 1 && result.back() < result[1])
        std::reverse(result.begin() + 1, result.end());
    return result;
}

/// Rings that bound the same place, in either direction: the first of them represents all.
struct Copies {
    std::vector<std::uint32_t> representative; ///< of each ring
    std::vector<std::uint32_t> next;           ///< the next copy of a ring, or none

    /// `apart`: there are none.
    Copies(const Layer& layer, std::span<const LeftEnd> ends, bool apart) : next(ends.size(), Nesting::none) {
        representative.resize(ends.size());
        std::iota(representative.begin(), representative.end(), 0U);
        if (apart)
            return;
        std::vector<std::uint32_t> order = representative;
        std::erase_if(order, [&](std::uint32_t i) { return layer.contour(i).empty(); });
        const auto begins_before = [&](std::uint32_t i, std::uint32_t j) {
            return ends[i].smallest < ends[j].smallest;
        };
        if (!std::is_sorted(order.begin(), order.end(), begins_before))
            std::stable_sort(order.begin(), order.end(), begins_before);
        for (std::size_t begin = 0, end = 0; begin < order.size(); begin = end) {
            const Point2& smallest = ends[order[begin]].smallest;
            end = begin + 1;
            while (end < order.size() && ends[order[end]].smallest == smallest)
                ++end;
            if (end - begin > 1)
                find_among(layer, std::span(order).subspan(begin, end - begin));
        }
    }

  private:
    void find_among(const Layer& layer, std::span<std::uint32_t> rings) {
        struct Candidate {
            std::vector<Point2> corners;
            std::uint32_t ring;
        };
        std::vector<Candidate> candidates;
        candidates.reserve(rings.size());
        for (const std::uint32_t ring : rings)
            candidates.push_back({corners(layer.contour(ring)), ring});
        std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
            return std::tie(a.corners, a.ring) < std::tie(b.corners, b.ring);
        });
        for (std::size_t i = 1; i < candidates.size(); ++i)
            if (candidates[i - 1].corners == candidates[i].corners) {
                representative[candidates[i].ring] = representative[candidates[i - 1].ring];
                next[candidates[i - 1].ring] = candidates[i].ring;
            }
    }
};

/// Edges that all reach from one abscissa to another one and beyond.
class Stack {
  public:
    void add(const Edge& edge) { ordered_.push_back(edge); }

    /// To be called once, after the last edge; x is an abscissa that all reach over.
    void order(double x) {
        struct Key {
            double height;
            double slope;
            std::size_t i;
        };
        std::vector<Key> keys;
        keys.reserve(ordered_.size());
        std::vector<Edge> edges = std::exchange(ordered_, {});
        for (std::size_t i = 0; i < edges.size(); ++i) {
            const auto& [lo, hi] = edges[i].line;
            const double slope = (hi.y - lo.y) / (hi.x - lo.x);
            const double height = lo.y + (x - lo.x) * slope;
            if (std::isfinite(height) && std::isfinite(slope))
                keys.push_back({height, slope, i});
            else
                loose_.push_back(edges[i]); // coordinates near the end of the number range
        }
        std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
            return std::tie(a.height, a.slope, a.i) < std::tie(b.height, b.slope, b.i);
        });
        // The order by rounded heights is right but for edges that cross or all but touch. Where two
        // neighbours are not in order, both are set aside: what remains is in order.
        for (const Key& key : keys) {
            const Edge& edge = edges[key.i];
            if (ordered_.empty() || nowhere_above(ordered_.back().line, edge.line)) {
                ordered_.push_back(edge);
            } else {
                loose_.push_back(ordered_.back());
                loose_.push_back(edge);
                ordered_.pop_back();
            }
        }
        for (auto begin = ordered_.begin(), end = begin; begin != ordered_.end(); begin = end) {
            end = begin + 1;
            while (end != ordered_.end() && nowhere_above(end->line, begin->line))
                ++end; // neither is above the other: they coincide
            std::sort(begin, end, [](const Edge& a, const Edge& b) { return a.order < b.order; });
        }
        winding_.reserve(ordered_.size() + 1);
        winding_.push_back(0);
        for (const Edge& edge : ordered_)
            winding_.push_back(winding_.back() + edge.step);
    }

    [[nodiscard]] bool empty() const noexcept { return ordered_.empty() && loose_.empty(); }

    /// The winding number below the edge, as far as this stack has a part in it.
    [[nodiscard]] std::int64_t winding_below(double x, const Edge& edge) const {
        std::int64_t result = winding_[first_not_below(x, edge)];
        for (const Edge& e : loose_)
            if (below(x, e, edge))
                result += e.step;
        return result;
    }

    /// Makes `best` the highest edge below `edge`, if that is higher than it.
    void raise(double x, const Edge& edge, const Edge*& best) const {
        const auto take = [&](const Edge& e) {
            if (best == nullptr || below(x, *best, e))
                best = &e;
        };
        const std::size_t end = first_not_below(x, edge);
        if (end > 0)
            take(ordered_[end - 1]);
        for (const Edge& e : loose_)
            if (below(x, e, edge))
                take(e);
    }

    /// How many edges coincide with `edge`, to the right of x, and have its place in that order.
    [[nodiscard]] std::int64_t count_equal(double x, const Edge& edge) const {
        Edge after = edge;
        ++after.order;
        auto result = static_cast<std::int64_t>(first_not_below(x, after) - first_not_below(x, edge));
        for (const Edge& e : loose_)
            result += below(x, e, after) && !below(x, e, edge) ? 1 : 0;
        return result;
    }

  private:
    /// True when s lies nowhere above t, as far as both exist from left to right.
    static bool nowhere_above(const Segment& s, const Segment& t) noexcept {
        const int left = s.lo.x > t.lo.x ? side(t, s.lo) : -side(s, t.lo);
        const int right = s.hi.x < t.hi.x ? side(t, s.hi) : -side(s, t.hi);
        return left <= 0 && right <= 0;
    }

    static bool below(double x, const Edge& a, const Edge& b) noexcept {
        const int by_place = compare_right_of(x, a.line, b.line);
        return by_place != 0 ? by_place < 0 : a.order < b.order;
    }

    [[nodiscard]] std::size_t first_not_below(double x, const Edge& edge) const {
        return static_cast<std::size_t>(
            std::partition_point(ordered_.begin(), ordered_.end(),
                                 [&](const Edge& e) { return below(x, e, edge); }) -
            ordered_.begin());
    }

    std::vector<Edge> ordered_;         ///< from below to above
    std::vector<std::int64_t> winding_; ///< above the first i of them
    std::vector<Edge> loose_;           ///< in no order
};

/// A segment tree over the abscissae of the left ends: each edge is kept in few nodes, and those with the
/// edges above and below a left end are the ancestors of one leaf.
class EdgesByAbscissa {
  public:
    explicit EdgesByAbscissa(std::vector<double> abscissae) : abscissae_(std::move(abscissae)) {
        std::sort(abscissae_.begin(), abscissae_.end());
        abscissae_.erase(std::unique(abscissae_.begin(), abscissae_.end()), abscissae_.end());
        leaves_ = std::bit_ceil(abscissae_.size());
        nodes_.resize(2 * leaves_);
    }

    /// The number of abscissae below x; `near` is a guess.
    [[nodiscard]] std::size_t leaf(double x, std::size_t near) const {
        if ((near == 0 || abscissae_[near - 1] < x) && (near == abscissae_.size() || x <= abscissae_[near]))
            return near;
        return static_cast<std::size_t>(std::lower_bound(abscissae_.begin(), abscissae_.end(), x) -
                                        abscissae_.begin());
    }

    /// Adds an edge that reaches over the leaves [first, end).
    void add(const Edge& edge, std::size_t first, std::size_t end) {
        for (first += leaves_, end += leaves_; first < end; first /= 2, end /= 2) {
            if (first % 2 == 1)
                nodes_[first++].add(edge);
            if (end % 2 == 1)
                nodes_[--end].add(edge);
        }
    }

    /// To be called once, after the last edge.
    void order() {
        for (std::size_t node = 1; node < nodes_.size(); ++node) {
            if (nodes_[node].empty())
                continue;
            std::size_t first = node;
            while (first < leaves_)
                first *= 2;
            nodes_[node].order(abscissae_[first - leaves_]);
        }
    }

    /// Calls visit(stack) for the stacks with edges over the abscissa x.
    template <class Visit>
    void for_stacks_at(double x, Visit visit) const {
        for (std::size_t node = leaves_ + leaf(x, 0); node > 0; node /= 2)
            if (!nodes_[node].empty())
                visit(nodes_[node]);
    }

  private:
    std::vector<double> abscissae_;
    std::size_t leaves_ = 0;
    std::vector<Stack> nodes_; // node i has the children 2 i and 2 i + 1
};

/// What is found at the left end of a ring.
struct Surroundings {
    std::int64_t winding = 0;
    const Edge* below = nullptr;
};

/// An edge that runs there and back bounds nothing on its own: it is passed over on the way down.
Surroundings surroundings(const EdgesByAbscissa& edges, const Edge& left_end) {
    const double x = left_end.line.lo.x;
    const auto opposite = [](Edge edge) {
        edge.order = -edge.order - 1;
        return edge;
    };
    const auto count = [&](const Edge& edge) {
        std::int64_t n = 0;
        edges.for_stacks_at(x, [&](const Stack& stack) { n += stack.count_equal(x, edge); });
        return n;
    };
    Surroundings result;
    edges.for_stacks_at(x, [&](const Stack& stack) { result.winding += stack.winding_below(x, left_end); });
    // Edges of the ring itself that run back on its lowest one come before it in the order.
    result.winding += left_end.step * count(opposite(left_end));
    Edge from = left_end;
    while (true) {
        const Edge* below = nullptr;
        edges.for_stacks_at(x, [&](const Stack& stack) { stack.raise(x, from, below); });
        if (below == nullptr)
            return result;
        if (below->ring != left_end.ring && count(*below) > count(opposite(*below))) {
            result.below = below;
            return result;
        }
        from = *below;
    }
}

class NestingSearch {
  public:
    /// `apart`: no two rings have a point in common, nor has one with itself.
    NestingSearch(const Layer& layer, const MonotoneChains& chains, bool apart)
        : layer_(layer), chains_(chains), apart_(apart), ends_(ends_of(layer, chains)),
          copies_(layer, ends_, apart) {
        for (std::uint32_t i = 0; i < ends_.size(); ++i)
            if (layer.contour(i).empty())
                result_.order.push_back(i);
            else if (copies_.representative[i] == i)
                order_.push_back(i);
    }

    /// `grid`: null where there is none.
    Nesting run(const ChainGrid* grid) && {
        const std::size_t n = ends_.size();
        result_.kind.assign(n, RingKind::flat);
        result_.parent.assign(n, Nesting::none);
        result_.depth.assign(n, 0);
        result_.winding.assign(n, 0);
        result_.winding_inside.assign(n, 0);
        result_.body.assign(n, Nesting::none);
        inside_.resize(n);
        around_.assign(n, Nesting::none);
        outside_.assign(n, Nesting::none);
        innermost_.assign(n, Nesting::none);
        if (order_.empty())
            return std::move(result_);
        rank_by_area();
        order_from_left_to_right();
        if (apart_ && grid != nullptr && !grid->crowded() && std::ranges::none_of(ends_, &LeftEnd::flat))
            place_apart(*grid);
        else
            place_any();
        return std::move(result_);
    }

  private:
    /// What the bodies are of which a place within a ring has material.
    struct Inside {
        std::uint32_t body = Nesting::none; ///< the innermost one
        std::uint32_t missing = 0;          ///< how many clockwise rings are too many
    };

    void place_any() {
        const EdgesByAbscissa edges = sorted_edges();
        for (const std::uint32_t ring : order_) {
            const Surroundings around = surroundings(edges, left_edge(ring));
            place(ring, parent_of(around), static_cast<std::int32_t>(around.winding));
        }
    }

    /// What is next below a left end tells all: the ring is inside of that one, or beside it.
    void place_apart(const ChainGrid& grid) {
        for (const std::uint32_t ring : order_) {
            const Point2& left = ends_[ring].line.lo;
            const std::optional<EdgeBelow> below =
                grid.surrounded(left, ring) ? edge_below(left, ring, chains_, grid) : std::nullopt;
            if (!below)
                place(ring, Nesting::none, 0);
            else if (below->rightwards == ends_[below->ring].rightwards)
                place(ring, below->ring, result_.winding_inside[below->ring]);
            else
                place(ring, result_.parent[below->ring], result_.winding[below->ring]);
        }
    }

    static std::vector<LeftEnd> ends_of(const Layer& layer, const MonotoneChains& chains) {
        std::vector<LeftEnd> ends(layer.rings);
        for (std::size_t i = 0; i < layer.rings; ++i)
            if (!layer.contour(i).empty())
                ends[i] = left_end(layer, chains, i);
        return ends;
    }

    /// Ranks only count where edges coincide, and areas take a look at all points.
    void rank_by_area() {
        rank_.resize(ends_.size());
        if (apart_) {
            std::iota(rank_.begin(), rank_.end(), 0U);
            return;
        }
        std::vector<double> area(ends_.size());
        for (const std::uint32_t ring : order_)
            area[ring] = ends_[ring].flat ? 0 : std::abs(ring_area(layer_.contour(ring)));
        std::vector<std::uint32_t> by_area = order_;
        std::sort(by_area.begin(), by_area.end(), [&](std::uint32_t a, std::uint32_t b) {
            return area[a] != area[b] ? area[a] > area[b] : a < b;
        });
        for (std::uint32_t i = 0; i < by_area.size(); ++i)
            rank_[by_area[i]] = i;
    }

    /// So that what lies below a left end comes before it.
    void order_from_left_to_right() {
        const auto before = [&](std::uint32_t a, std::uint32_t b) {
            const Segment& s = ends_[a].line;
            const Segment& t = ends_[b].line;
            if (s.lo != t.lo)
                return s.lo < t.lo;
            const int by_slope = compare_at(s, t);
            return by_slope != 0 ? by_slope < 0 : rank_[a] < rank_[b];
        };
        if (!std::is_sorted(order_.begin(), order_.end(), before)) // rings in normal form all but are
            std::sort(order_.begin(), order_.end(), before);
    }

    [[nodiscard]] EdgesByAbscissa sorted_edges() const {
        std::vector<double> abscissae;
        abscissae.reserve(order_.size());
        for (const std::uint32_t ring : order_)
            abscissae.push_back(ends_[ring].line.lo.x);
        EdgesByAbscissa edges(std::move(abscissae));
        std::size_t near = 0;
        for (const std::uint32_t ring : order_) {
            if (ends_[ring].flat)
                continue;
            const std::int32_t net = net_winding(ring);
            for (const Chain& chain : chains_.of_ring(ring)) {
                const std::size_t from = edges.leaf(chain.front.x, near);
                near = edges.leaf(chain.back.x, from);
                if (from != near) // others reach over no left end
                    add_edges(chain, net, from, edges);
            }
        }
        edges.order();
        return edges;
    }

    /// The edges of a chain that reach over left ends. `net`: of its ring; `leaf`: of its first point.
    void add_edges(const Chain& chain, std::int32_t net, std::size_t leaf, EdgesByAbscissa& edges) const {
        const std::uint32_t ring = chain.ring;
        const bool rightwards = (chain.ways & way::right) != 0;
        const bool inside_above = rightwards == ends_[ring].rightwards;
        const std::int32_t step = inside_above ? net : -net;
        const std::int64_t order = place_in_order(ring, inside_above);
        for (std::uint32_t i = 0; i < chain.segments; ++i) {
            const Point2& a = chains_.point(chain, i);
            const Point2& b = chains_.point(chain, i + 1);
            const std::size_t next = edges.leaf(b.x, leaf);
            if (next != leaf)
                edges.add({rightwards ? Segment{a, b} : Segment{b, a}, ring, step, order},
                          std::min(leaf, next), std::max(leaf, next));
            leaf = next;
        }
    }

    [[nodiscard]] std::int64_t place_in_order(std::uint32_t ring, bool inside_above) const noexcept {
        const auto rank = static_cast<std::int64_t>(rank_[ring]);
        return inside_above ? rank : -rank - 1;
    }

    /// How often the copies of a ring wind around its inside.
    [[nodiscard]] std::int32_t net_winding(std::uint32_t ring) const noexcept {
        std::int32_t net = 0;
        for (std::uint32_t copy = ring; copy != Nesting::none; copy = copies_.next[copy])
            net += ends_[copy].rightwards ? 1 : -1;
        return net;
    }

    [[nodiscard]] Edge left_edge(std::uint32_t ring) const noexcept {
        return {ends_[ring].line, ring, ends_[ring].flat ? 0 : net_winding(ring), place_in_order(ring, true)};
    }

    [[nodiscard]] std::uint32_t parent_of(const Surroundings& around) const noexcept {
        if (around.below == nullptr)
            return Nesting::none;
        const std::uint32_t below = around.below->ring;
        return around.below->order >= 0 ? innermost_[below] : outside_[below];
    }

    /// Places a ring and its copies, one within the other, into `parent`.
    void place(std::uint32_t ring, std::uint32_t parent, std::int32_t winding) {
        outside_[ring] = innermost_[ring] = parent;
        if (ends_[ring].flat) {
            for (std::uint32_t copy = ring; copy != Nesting::none; copy = copies_.next[copy])
                place_one(copy, parent, winding, RingKind::flat);
            return;
        }
        std::uint32_t body = next_copy(ring, true);
        std::uint32_t hole = next_copy(ring, false);
        while (body != Nesting::none || hole != Nesting::none) {
            std::uint32_t& last = innermost_[ring];
            if (body == Nesting::none || (winding >= 1 && hole != Nesting::none)) {
                place_one(hole, last, winding, winding < 1 ? RingKind::misoriented : RingKind::hole);
                last = hole;
                --winding;
                hole = next_copy(copies_.next[hole], false);
            } else {
                place_one(body, last, winding,
                          winding < 0    ? RingKind::misoriented
                          : winding == 0 ? RingKind::outer
                                         : RingKind::overlapping);
                last = body;
                ++winding;
                body = next_copy(copies_.next[body], true);
            }
        }
    }

    /// The first one, from `ring` on, that runs the given way round.
    [[nodiscard]] std::uint32_t next_copy(std::uint32_t ring, bool counter_clockwise) const noexcept {
        while (ring != Nesting::none && ends_[ring].rightwards != counter_clockwise)
            ring = copies_.next[ring];
        return ring;
    }

    void place_one(std::uint32_t ring, std::uint32_t parent, std::int32_t winding, RingKind kind) {
        result_.kind[ring] = kind;
        result_.parent[ring] = parent;
        result_.winding[ring] = result_.winding_inside[ring] = winding;
        result_.order.push_back(ring);
        Inside& inside = inside_[ring];
        if (parent != Nesting::none) {
            result_.depth[ring] = result_.depth[parent] + 1;
            inside = inside_[parent];
        }
        if (kind == RingKind::flat)
            return;
        result_.winding_inside[ring] += ends_[ring].rightwards ? 1 : -1;
        if (ends_[ring].rightwards) {
            if (inside.missing > 0) {
                --inside.missing;
            } else {
                around_[ring] = inside.body;
                inside.body = result_.body[ring] = ring;
            }
        } else if (inside.body == Nesting::none) {
            ++inside.missing;
        } else {
            result_.body[ring] = inside.body;
            inside.body = around_[inside.body];
        }
    }

    const Layer& layer_;
    const MonotoneChains& chains_;
    bool apart_;
    std::vector<LeftEnd> ends_;
    Copies copies_;
    std::vector<std::uint32_t> order_; ///< the representatives
    std::vector<std::uint32_t> rank_;  ///< of representatives: 0 for the largest
    Nesting result_;
    std::vector<Inside> inside_;
    std::vector<std::uint32_t> around_;    ///< of a body: the body in which it lies
    std::vector<std::uint32_t> outside_;   ///< of a representative: the parent of the first of its copies
    std::vector<std::uint32_t> innermost_; ///< of a representative: the last of its copies
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
    return nesting(layer, chains, grid ? &*grid : nullptr,
                   find_contacts(layer, chains, grid ? &*grid : nullptr));
}

Nesting nesting(const Layer& layer, const MonotoneChains& chains, const ChainGrid* grid,
                const Contacts& contacts) {
    check_size(layer);
    return NestingSearch(layer, chains, contacts.groups == 0).run(grid);
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
