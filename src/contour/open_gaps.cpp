#include "lamella/contour/open_gaps.hpp"

#include "contour/distance.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr std::size_t none = ~std::size_t{0};

/// Points of which the nearest is asked for, and which are taken away one by one. A tree of medians along the
/// longer side: the middle of a range is the median of it, those before it are no greater. Ranges know their
/// boxes, so that thousands of points in one place are looked at as one.
class NearestPoints {
  public:
    explicit NearestPoints(std::vector<Point2> points)
        : points_(std::move(points)), order_(points_.size()), place_(points_.size()), nodes_(points_.size()),
          gone_(points_.size(), false) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        build({0, order_.size()});
        for (std::size_t place = 0; place < order_.size(); ++place)
            place_[order_[place]] = place;
    }

    /// The number of the nearest one left for which `fits(number, distance)`, or none.
    template <class Fits>
    [[nodiscard]] std::size_t nearest(const Point2& to, const Fits& fits) const {
        Best best;
        search({0, order_.size()}, to, fits, best);
        return best.number;
    }

    void remove(std::size_t number) {
        assert(number < points_.size() && !gone_[number]);
        Range range{0, order_.size()};
        for (;; range = place_[number] < range.middle() ? range.before() : range.after()) {
            --nodes_[range.middle()].left;
            if (place_[number] == range.middle())
                break;
        }
        gone_[number] = true;
    }

  private:
    struct Range {
        std::size_t begin;
        std::size_t end;

        [[nodiscard]] bool empty() const noexcept { return begin == end; }
        [[nodiscard]] std::size_t middle() const noexcept { return begin + (end - begin) / 2; }
        [[nodiscard]] Range before() const noexcept { return {begin, middle()}; }
        [[nodiscard]] Range after() const noexcept { return {middle() + 1, end}; }
    };
    struct Best {
        double distance = std::numeric_limits<double>::infinity();
        std::size_t number = none;
    };

    /// Of a range, by the place of its middle.
    struct Node {
        std::size_t left = 0; ///< how many points are
        double Point2::*axis = nullptr;
        Point2 low;
        Point2 high;

        /// No point of the range is closer.
        [[nodiscard]] double distance_to(const Point2& p) const noexcept {
            return hypotenuse(std::max({low.x - p.x, 0.0, p.x - high.x}),
                              std::max({low.y - p.y, 0.0, p.y - high.y}));
        }
    };

    void build(const Range& range) {
        if (range.empty())
            return;
        const auto at = [&](std::size_t place) {
            return order_.begin() + static_cast<std::ptrdiff_t>(place);
        };
        Point2 low = points_[*at(range.begin)];
        Point2 high = low;
        for (std::size_t place = range.begin; place < range.end; ++place) {
            const Point2& p = points_[*at(place)];
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        double Point2::*const axis = high.x - low.x >= high.y - low.y ? &Point2::x : &Point2::y;
        // Equal ones by their numbers, so that the tree is the same everywhere.
        std::nth_element(at(range.begin), at(range.middle()), at(range.end),
                         [&](std::size_t a, std::size_t b) {
                             return std::tuple(points_[a].*axis, a) < std::tuple(points_[b].*axis, b);
                         });
        nodes_[range.middle()] = {range.end - range.begin, axis, low, high};
        build(range.before());
        build(range.after());
    }

    template <class Fits>
    void search(const Range& range, const Point2& to, const Fits& fits, Best& best) const {
        if (range.empty())
            return;
        const Node& node = nodes_[range.middle()];
        if (node.left == 0 || !(node.distance_to(to) < best.distance))
            return;
        const std::size_t number = order_[range.middle()];
        if (!gone_[number])
            if (const double d = distance(points_[number], to); d < best.distance && fits(number, d))
                best = {d, number};
        const bool before = to.*node.axis < points_[number].*node.axis;
        search(before ? range.before() : range.after(), to, fits, best);
        search(before ? range.after() : range.before(), to, fits, best);
    }

    std::vector<Point2> points_;
    std::vector<std::size_t> order_;
    std::vector<std::size_t> place_; ///< of a point in `order_`
    std::vector<Node> nodes_;
    std::vector<bool> gone_;
};

/// From the end of one chain to the start of another.
struct Gap {
    double length;
    std::size_t from;
    std::size_t to;

    friend bool operator>(const Gap& a, const Gap& b) noexcept {
        return std::tuple(a.length, a.from, a.to) > std::tuple(b.length, b.from, b.to);
    }
};

double length_of(std::span<const Point2> chain) {
    double length = 0;
    for (std::size_t i = 1; i < chain.size(); ++i)
        length += distance(chain[i - 1], chain[i]);
    return length;
}

/// Every chain is followed by one, and follows one: visit(from, to) for all gaps.
template <class Visit>
void for_each_gap(const std::vector<std::span<const Point2>>& chains, const Visit& visit) {
    std::vector<Point2> first_points;
    std::vector<double> lengths;
    for (const std::span<const Point2> chain : chains) {
        first_points.push_back(chain.front());
        lengths.push_back(length_of(chain));
    }
    NearestPoints starts(std::move(first_points));
    std::vector<bool> taken(chains.size(), false);   // starts
    std::vector<bool> matched(chains.size(), false); // ends
    std::priority_queue<Gap, std::vector<Gap>, std::greater<>> closest;
    const auto propose = [&](std::size_t from) {
        const Point2 end = chains[from].back();
        const std::size_t to = starts.nearest(end, [&](std::size_t start, double length) {
            return start != from || 2 * length <= lengths[from];
        });
        if (to != none)
            closest.push({distance(end, chains[to].front()), from, to});
    };
    for (std::size_t c = 0; c < chains.size(); ++c)
        propose(c);
    constexpr unsigned char most_times = 16;
    std::vector<unsigned char> forestalled(chains.size(), 0);
    while (!closest.empty()) {
        const Gap gap = closest.top();
        closest.pop();
        if (taken[gap.to]) {
            if (++forestalled[gap.from] < most_times)
                propose(gap.from);
            continue;
        }
        assert(!matched[gap.from]);
        taken[gap.to] = matched[gap.from] = true;
        starts.remove(gap.to);
        visit(chains[gap.from].back(), chains[gap.to].front());
    }
    for (std::size_t from = 0, to = 0; from < chains.size(); ++from) {
        if (matched[from])
            continue;
        while (taken[to])
            ++to;
        assert(to < chains.size()); // as many starts are left as ends
        visit(chains[from].back(), chains[to++].front());
    }
}

} // namespace

OpenGaps& OpenGaps::operator+=(const OpenGaps& other) noexcept {
    if (other.longest_mm > longest_mm || count == 0) {
        longest_mm = other.longest_mm;
        from = other.from;
        to = other.to;
    }
    count += other.count;
    total_mm += other.total_mm;
    return *this;
}

OpenGaps open_gaps(const Layer& layer) {
    OpenGaps all;
    std::vector<std::span<const Point2>> chains;
    for (std::size_t c = layer.rings; c < layer.contours(); ++c)
        if (!layer.contour(c).empty())
            chains.push_back(layer.contour(c));
    if (chains.empty())
        return all;
    for_each_gap(chains, [&](const Point2& from, const Point2& to) {
        const double length = distance(from, to);
        all += {.count = 1, .longest_mm = length, .total_mm = length, .from = from, .to = to};
    });
    assert(all.count == chains.size());
    return all;
}

} // namespace lamella
