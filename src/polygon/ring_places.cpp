#include "polygon/ring_places.hpp"

#include "polygon/orientation.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// An edge of a ring that is not vertical; `rightwards` when it runs from lo to hi: material above it.
struct Edge {
    Segment line;
    bool rightwards;
};

/// Calls visit(edge) for the edges of a ring that are not vertical.
template <class Visit>
void for_edges(std::span<const Point2> ring, Visit visit) {
    if (ring.empty())
        return;
    const Point2* previous = &ring.back();
    for (const Point2& p : ring) {
        if (previous->x < p.x)
            visit(Edge{{*previous, p}, true});
        else if (p.x < previous->x)
            visit(Edge{{p, *previous}, false});
        previous = &p;
    }
}

/// How `edge` lies to the line of `probe` just to the right of probe.lo, where both exist: -1 below, 0 on it,
/// 1 above.
int compare_at(const Edge& edge, const Segment& probe) noexcept {
    const int by_place = -side(edge.line, probe.lo);
    return by_place != 0 ? by_place : -side(edge.line, probe.hi);
}

/// The lowest edge at the ring's left end. None when the ring has no width.
std::optional<Edge> leftmost_edge(std::span<const Point2> ring) {
    std::optional<Edge> best;
    for_edges(ring, [&](const Edge& edge) {
        if (!best || edge.line.lo < best->line.lo ||
            (edge.line.lo == best->line.lo && compare_at(edge, best->line) < 0))
            best = edge;
    });
    return best;
}

/// True when a lies nowhere above b, as far as both exist from left to right.
bool nowhere_above(const Edge& a, const Edge& b) noexcept {
    const Segment& s = a.line;
    const Segment& t = b.line;
    const int left = s.lo.x > t.lo.x ? side(t, s.lo) : -side(s, t.lo);
    const int right = s.hi.x < t.hi.x ? side(t, s.hi) : -side(s, t.hi);
    return left <= 0 && right <= 0;
}

/// What lies at a ring's leftmost edge: the winding number below it, and the edges that coincide with it.
struct Surroundings {
    std::int64_t below = 0;
    std::int64_t rightwards = 0;
    std::int64_t leftwards = 0;
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
            if (ordered_.empty() || nowhere_above(ordered_.back(), edge)) {
                ordered_.push_back(edge);
            } else {
                loose_.push_back(ordered_.back());
                loose_.push_back(edge);
                ordered_.pop_back();
            }
        }
        winding_.reserve(ordered_.size() + 1);
        winding_.push_back(0);
        for (const Edge& edge : ordered_)
            winding_.push_back(winding_.back() + step(edge));
    }

    [[nodiscard]] bool empty() const noexcept { return ordered_.empty() && loose_.empty(); }

    /// Adds what this stack has below a probe and on it.
    void add_to(Surroundings& sum, const Segment& probe) const {
        auto edge = std::partition_point(ordered_.begin(), ordered_.end(),
                                         [&](const Edge& e) { return compare_at(e, probe) < 0; });
        sum.below += winding_[static_cast<std::size_t>(edge - ordered_.begin())];
        for (; edge != ordered_.end() && compare_at(*edge, probe) == 0; ++edge)
            ++(edge->rightwards ? sum.rightwards : sum.leftwards);
        for (const Edge& e : loose_) {
            const int place = compare_at(e, probe);
            if (place < 0)
                sum.below += step(e);
            else if (place == 0)
                ++(e.rightwards ? sum.rightwards : sum.leftwards);
        }
    }

  private:
    [[nodiscard]] static int step(const Edge& edge) noexcept { return edge.rightwards ? 1 : -1; }

    std::vector<Edge> ordered_;         ///< from below to above
    std::vector<std::int64_t> winding_; ///< above the first i of them
    std::vector<Edge> loose_;           ///< in no order
};

/// A segment tree over the abscissae of the probes: each edge is kept in few nodes, and those with the edges
/// above and below a probe are the ancestors of one leaf.
class EdgesByAbscissa {
  public:
    explicit EdgesByAbscissa(std::vector<double> abscissae) : abscissae_(std::move(abscissae)) {
        std::sort(abscissae_.begin(), abscissae_.end());
        abscissae_.erase(std::unique(abscissae_.begin(), abscissae_.end()), abscissae_.end());
        leaves_ = std::bit_ceil(abscissae_.size());
        nodes_.resize(2 * leaves_);
    }

    /// Edges that reach over no abscissa are forgotten.
    void add(const Edge& edge) {
        std::size_t first = leaves_ + leaf(edge.line.lo.x);
        std::size_t end = leaves_ + leaf(edge.line.hi.x);
        for (; first < end; first /= 2, end /= 2) {
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

    [[nodiscard]] Surroundings around(const Segment& probe) const {
        Surroundings result;
        for (std::size_t node = leaves_ + leaf(probe.lo.x); node > 0; node /= 2)
            if (!nodes_[node].empty())
                nodes_[node].add_to(result, probe);
        return result;
    }

  private:
    [[nodiscard]] std::size_t leaf(double x) const {
        return static_cast<std::size_t>(std::lower_bound(abscissae_.begin(), abscissae_.end(), x) -
                                        abscissae_.begin());
    }

    std::vector<double> abscissae_;
    std::size_t leaves_ = 0;
    std::vector<Stack> nodes_; // node i has the children 2 i and 2 i + 1
};

RingPlace place_of(const Edge& edge, const Surroundings& around) {
    // Crossing edges that coincide in the kindest order, rightwards ones (they add one) come first ...
    if (around.below + around.rightwards < 1)
        return RingPlace::misoriented;
    // ... and to be taken for another body's, material must be below also when leftwards ones come first.
    if (edge.rightwards && around.below - around.leftwards >= 1)
        return RingPlace::overlapping;
    return RingPlace::sound;
}

} // namespace

std::vector<RingPlace> ring_places(const Layer& layer) {
    std::vector<std::optional<Edge>> probes(layer.rings);
    std::vector<double> abscissae;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        probes[i] = leftmost_edge(layer.contour(i));
        if (probes[i])
            abscissae.push_back(probes[i]->line.lo.x);
    }
    std::vector<RingPlace> result(layer.rings, RingPlace::sound);
    if (abscissae.empty())
        return result;
    EdgesByAbscissa edges(std::move(abscissae));
    for (std::size_t i = 0; i < layer.rings; ++i)
        for_edges(layer.contour(i), [&](const Edge& edge) { edges.add(edge); });
    edges.order();
    for (std::size_t i = 0; i < layer.rings; ++i)
        if (probes[i])
            result[i] = place_of(*probes[i], edges.around(probes[i]->line));
    return result;
}

} // namespace lamella
