#include "polygon/edges_by_x.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// Returns whether s is nowhere above t on their common interval of x.
bool nowhere_above(const Segment& s, const Segment& t) noexcept {
    const int left = s.lo.x > t.lo.x ? side(t, s.lo) : -side(s, t.lo);
    const int right = s.hi.x < t.hi.x ? side(t, s.hi) : -side(s, t.hi);
    return left <= 0 && right <= 0;
}

bool below(double x, const RingEdge& a, const RingEdge& b) noexcept {
    const int by_position = compare_right_of(x, a.line, b.line);
    return by_position != 0 ? by_position < 0 : a.order < b.order;
}

} // namespace

void EdgeColumn::order(double x) {
    struct Key {
        double height;
        double slope;
        std::size_t i;
    };
    std::vector<Key> keys;
    keys.reserve(ordered_.size());
    std::vector<RingEdge> edges = std::exchange(ordered_, {});
    for (std::size_t i = 0; i < edges.size(); ++i) {
        const auto& [lo, hi] = edges[i].line;
        const double slope = (hi.y - lo.y) / (hi.x - lo.x);
        const double height = lo.y + (x - lo.x) * slope;
        if (std::isfinite(height) && std::isfinite(slope))
            keys.push_back({height, slope, i});
        else
            loose_.push_back(edges[i]); // coordinates near the limits of double
    }
    std::sort(keys.begin(), keys.end(), [](const Key& a, const Key& b) {
        return std::tie(a.height, a.slope, a.i) < std::tie(b.height, b.slope, b.i);
    });
    // The order by rounded heights is correct except for edges that cross or nearly touch. If two neighbours
    // are out of order, both are set aside; the remaining edges are in order.
    for (const Key& key : keys) {
        const RingEdge& edge = edges[key.i];
        if (ordered_.empty() || nowhere_above(ordered_.back().line, edge.line)) {
            ordered_.push_back(edge);
        } else {
            loose_.push_back(ordered_.back());
            loose_.push_back(edge);
            ordered_.pop_back();
        }
    }
    assert(std::adjacent_find(ordered_.begin(), ordered_.end(), [](const RingEdge& a, const RingEdge& b) {
               return !nowhere_above(a.line, b.line);
           }) == ordered_.end());
    for (auto begin = ordered_.begin(), end = begin; begin != ordered_.end(); begin = end) {
        end = begin + 1;
        while (end != ordered_.end() && nowhere_above(end->line, begin->line))
            ++end; // neither is above the other, so they coincide
        std::sort(begin, end, [](const RingEdge& a, const RingEdge& b) { return a.order < b.order; });
    }
    assert(ordered_.size() + loose_.size() == edges.size());
    winding_.reserve(ordered_.size() + 1);
    winding_.emplace_back();
    for (const RingEdge& edge : ordered_)
        winding_.push_back(winding_.back() + edge.step);
}

Windings EdgeColumn::winding_below(double x, const RingEdge& edge) const {
    assert(winding_.size() == ordered_.size() + 1); // they are in order
    Windings result = winding_[first_not_below(x, edge)];
    for (const RingEdge& e : loose_)
        if (below(x, e, edge))
            result += e.step;
    return result;
}

void EdgeColumn::raise(double x, const RingEdge& edge, const RingEdge*& best) const {
    const auto take = [&](const RingEdge& e) {
        if (best == nullptr || below(x, *best, e))
            best = &e;
    };
    const std::size_t end = first_not_below(x, edge);
    if (end > 0)
        take(ordered_[end - 1]);
    for (const RingEdge& e : loose_)
        if (below(x, e, edge))
            take(e);
}

std::int64_t EdgeColumn::count_equal(double x, const RingEdge& edge) const {
    RingEdge after = edge;
    ++after.order;
    auto result = static_cast<std::int64_t>(first_not_below(x, after) - first_not_below(x, edge));
    for (const RingEdge& e : loose_)
        result += e.order == edge.order && compare_right_of(x, e.line, edge.line) == 0 ? 1 : 0;
    return result;
}

std::size_t EdgeColumn::first_not_below(double x, const RingEdge& edge) const {
    return static_cast<std::size_t>(
        std::partition_point(ordered_.begin(), ordered_.end(),
                             [&](const RingEdge& e) { return below(x, e, edge); }) -
        ordered_.begin());
}

EdgesByX::EdgesByX(std::vector<double> abscissae) : abscissae_(std::move(abscissae)) {
    std::sort(abscissae_.begin(), abscissae_.end());
    abscissae_.erase(std::unique(abscissae_.begin(), abscissae_.end()), abscissae_.end());
    leaves_ = std::bit_ceil(abscissae_.size());
    nodes_.resize(2 * leaves_);
}

std::size_t EdgesByX::leaf(double x, std::size_t near) const {
    assert(near <= abscissae_.size());
    if ((near == 0 || abscissae_[near - 1] < x) && (near == abscissae_.size() || x <= abscissae_[near]))
        return near;
    return static_cast<std::size_t>(std::lower_bound(abscissae_.begin(), abscissae_.end(), x) -
                                    abscissae_.begin());
}

void EdgesByX::add(const RingEdge& edge, std::size_t first, std::size_t end) {
    assert(first < end && end <= abscissae_.size());
    for (first += leaves_, end += leaves_; first < end; first /= 2, end /= 2) {
        if (first % 2 == 1)
            nodes_[first++].add(edge);
        if (end % 2 == 1)
            nodes_[--end].add(edge);
    }
}

void EdgesByX::order() {
    for (std::size_t node = 1; node < nodes_.size(); ++node) {
        if (nodes_[node].empty())
            continue;
        std::size_t first = node;
        while (first < leaves_)
            first *= 2;
        nodes_[node].order(abscissae_[first - leaves_]);
    }
}

} // namespace lamella
