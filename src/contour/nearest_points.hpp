#pragma once

#include "lamella/core/point.hpp"

#include "contour/distance.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

namespace lamella {

/// Points for nearest-neighbour queries, which can be removed one by one. They form a k-d tree: the middle of
/// a range is its median along the longer side of its box, and the points before it are no greater. Ranges
/// store their boxes, so that thousands of coincident points are examined together.
class NearestPoints {
  public:
    static constexpr std::size_t none = ~std::size_t{0};

    explicit NearestPoints(std::vector<Point2> points)
        : points_(std::move(points)), order_(points_.size()), position_(points_.size()),
          nodes_(points_.size()), gone_(points_.size(), false) {
        std::iota(order_.begin(), order_.end(), std::size_t{0});
        build({0, order_.size()});
        for (std::size_t position = 0; position < order_.size(); ++position)
            position_[order_[position]] = position;
    }

    /// Calls visit(number, distance, below) for remaining points that are closer than `below`; the visitor
    /// may lower this bound. The order is unspecified, but points that are likely to be near come first.
    template <class Visit>
    void for_each_closer(const Point2& to, double below, const Visit& visit) const {
        search({0, order_.size()}, to, below, visit);
    }

    /// Returns the number of the nearest remaining point for which `fits(number, distance)`, or none.
    template <class Fits>
    [[nodiscard]] std::size_t nearest(const Point2& to, const Fits& fits) const {
        std::size_t best = none;
        for_each_closer(to, std::numeric_limits<double>::infinity(),
                        [&](std::size_t number, double distance, double& below) {
                            if (fits(number, distance)) {
                                best = number;
                                below = distance;
                            }
                        });
        return best;
    }

    void remove(std::size_t number) {
        assert(number < points_.size() && !gone_[number]);
        Range range{0, order_.size()};
        for (;; range = position_[number] < range.middle() ? range.before() : range.after()) {
            --nodes_[range.middle()].left;
            if (position_[number] == range.middle())
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

    /// Data of a range, stored at the index of its middle.
    struct Node {
        std::size_t left = 0; ///< number of remaining points
        double Point2::*axis = nullptr;
        Point2 low;
        Point2 high;

        /// Lower bound on the distance of all points of the range.
        [[nodiscard]] double distance_to(const Point2& p) const noexcept {
            return hypotenuse(std::max({low.x - p.x, 0.0, p.x - high.x}),
                              std::max({low.y - p.y, 0.0, p.y - high.y}));
        }
    };

    void build(const Range& range) {
        if (range.empty())
            return;
        const auto at = [&](std::size_t position) {
            return order_.begin() + static_cast<std::ptrdiff_t>(position);
        };
        Point2 low = points_[*at(range.begin)];
        Point2 high = low;
        for (std::size_t position = range.begin; position < range.end; ++position) {
            const Point2& p = points_[*at(position)];
            low = {std::min(low.x, p.x), std::min(low.y, p.y)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y)};
        }
        double Point2::*const axis = high.x - low.x >= high.y - low.y ? &Point2::x : &Point2::y;
        // Equal points are ordered by number, so that the tree is the same everywhere.
        std::nth_element(at(range.begin), at(range.middle()), at(range.end),
                         [&](std::size_t a, std::size_t b) {
                             return std::tuple(points_[a].*axis, a) < std::tuple(points_[b].*axis, b);
                         });
        nodes_[range.middle()] = {range.end - range.begin, axis, low, high};
        build(range.before());
        build(range.after());
    }

    template <class Visit>
    void search(const Range& range, const Point2& to, double& below, const Visit& visit) const {
        if (range.empty())
            return;
        const Node& node = nodes_[range.middle()];
        if (node.left == 0 || !(node.distance_to(to) < below))
            return;
        const std::size_t number = order_[range.middle()];
        if (!gone_[number])
            if (const double d = distance(points_[number], to); d < below)
                visit(number, d, below);
        const bool before = to.*node.axis < points_[number].*node.axis;
        search(before ? range.before() : range.after(), to, below, visit);
        search(before ? range.after() : range.before(), to, below, visit);
    }

    std::vector<Point2> points_;
    std::vector<std::size_t> order_;
    std::vector<std::size_t> position_; ///< index of a point in `order_`
    std::vector<Node> nodes_;
    std::vector<bool> gone_;
};

} // namespace lamella
