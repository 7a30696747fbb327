#include "polygon/edge_tree.hpp"

#include "contour/distance.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace lamella {

namespace {

constexpr double far_away = std::numeric_limits<double>::infinity();
constexpr std::size_t edges_of_leaf = 8;

double squared(double dx, double dy) noexcept {
    return dx * dx + dy * dy;
}

/// Returns the distance between two boxes along an axis.
double gap(double least, double most, double other_least, double other_most) noexcept {
    return std::max({other_least - most, 0.0, least - other_most});
}

double apart_squared(const Box2& a, const Box2& b) noexcept {
    return squared(gap(a.x0, a.x1, b.x0, b.x1), gap(a.y0, a.y1, b.y0, b.y1));
}

} // namespace

EdgeTree::EdgeTree(const Layer& layer) {
    edges_.reserve(layer.points.size());
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const auto contour = layer.contour(i);
        if (contour.empty())
            continue;
        for (std::size_t k = 1; k < contour.size(); ++k)
            edges_.push_back({contour[k - 1], contour[k]});
        if (layer.closed(i) || contour.size() == 1)
            edges_.push_back({contour.back(), contour.front()});
    }
    if (!edges_.empty())
        build(0, edges_.size());
}

void EdgeTree::build(std::size_t begin, std::size_t end) {
    const std::size_t at = nodes_.size();
    Box2 box = Box2::of(edges_[begin].a, edges_[begin].b);
    Box2 middles = Box2::of(edges_[begin].middle());
    for (std::size_t i = begin + 1; i < end; ++i) {
        box.add(Box2::of(edges_[i].a, edges_[i].b));
        middles.add(Box2::of(edges_[i].middle()));
    }
    nodes_.push_back({box, begin, end, 0});
    if (end - begin <= edges_of_leaf)
        return;
    const std::size_t middle = begin + (end - begin) / 2;
    const auto position = [&](std::size_t i) {
        return edges_.begin() + static_cast<std::ptrdiff_t>(i);
    };
    // The midpoints of long parallel walls are spread along a line across the walls.
    const bool along_x = middles.width() >= middles.height();
    std::nth_element(position(begin), position(middle), position(end), [&](const Edge& s, const Edge& t) {
        return along_x ? s.middle().x < t.middle().x : s.middle().y < t.middle().y;
    });
    build(begin, middle);
    nodes_[at].right = nodes_.size();
    build(middle, end);
}

template <class OfBox, class OfEdge>
void EdgeTree::search(std::size_t at, double enough, const OfBox& of_box, const OfEdge& of_edge,
                      double& best) const {
    const Node& node = nodes_[at];
    if (node.right == 0) {
        for (std::size_t i = node.begin; i < node.end; ++i)
            best = std::min(best, of_edge(edges_[i]));
        return;
    }
    std::size_t near = at + 1;
    std::size_t far = node.right;
    double to_near = of_box(nodes_[near].box);
    double to_far = of_box(nodes_[far].box);
    if (to_far < to_near) {
        std::swap(near, far);
        std::swap(to_near, to_far);
    }
    if (to_near < best)
        search(near, enough, of_box, of_edge, best);
    if (best > enough && to_far < best)
        search(far, enough, of_box, of_edge, best);
}

double EdgeTree::distance_squared(const Point2& p, double enough) const {
    double best = far_away;
    const Box2 own = Box2::of(p);
    if (!empty())
        search(
            0, enough, [&](const Box2& box) { return apart_squared(own, box); },
            [&](const Edge& edge) { return lamella::distance_squared(p, edge.a, edge.b); }, best);
    return best;
}

std::pair<Point2, Point2> EdgeTree::nearest(const Point2& p) const {
    assert(!empty());
    double best = far_away;
    std::pair<Point2, Point2> nearest;
    const Box2 own = Box2::of(p);
    search(
        0, 0, [&](const Box2& box) { return apart_squared(own, box); },
        [&](const Edge& edge) {
            const double squared = lamella::distance_squared(p, edge.a, edge.b);
            if (squared < best)
                nearest = {edge.a, edge.b};
            return squared;
        },
        best);
    return nearest;
}

double EdgeTree::distance_squared(const Segment& s, double enough) const {
    double best = far_away;
    const Box2 own = Box2::of(s.lo, s.hi);
    const double length = std::sqrt(squared(s.hi.x - s.lo.x, s.hi.y - s.lo.y));
    Point2 normal;
    if (length > 0)
        normal = {(s.lo.y - s.hi.y) / length, (s.hi.x - s.lo.x) / length};
    // A lower bound of the squared distance of a box from the line of the segment. For a diagonal segment,
    // the box of the segment would be a poor bound.
    const auto squared_from_line = [&](const Box2& box) {
        const double middle =
            normal.x * ((box.x0 + box.x1) / 2 - s.lo.x) + normal.y * ((box.y0 + box.y1) / 2 - s.lo.y);
        const double half = (std::abs(normal.x) * box.width() + std::abs(normal.y) * box.height()) / 2;
        const double apart = std::max(0.0, std::abs(middle) - half);
        return apart * apart;
    };
    if (!empty())
        search(
            0, enough,
            [&](const Box2& box) { return std::max(apart_squared(own, box), squared_from_line(box)); },
            [&](const Edge& edge) {
                return meet(s, segment_between(edge.a, edge.b))
                           ? 0
                           : std::min({lamella::distance_squared(s.lo, edge.a, edge.b),
                                       lamella::distance_squared(s.hi, edge.a, edge.b),
                                       lamella::distance_squared(edge.a, s.lo, s.hi),
                                       lamella::distance_squared(edge.b, s.lo, s.hi)});
            },
            best);
    return best;
}

std::int64_t EdgeTree::winding(const Point2& p) const {
    return empty() ? 0 : winding_below(0, p);
}

std::int64_t EdgeTree::winding_below(std::size_t at, const Point2& p) const {
    const Node& node = nodes_[at];
    if (node.box.y0 > p.y || node.box.y1 <= p.y || node.box.x1 < p.x)
        return 0;
    if (node.right != 0)
        return winding_below(at + 1, p) + winding_below(node.right, p);
    std::int64_t around = 0;
    for (std::size_t i = node.begin; i < node.end; ++i) {
        const Edge& edge = edges_[i];
        if ((edge.a.y > p.y) == (edge.b.y > p.y))
            continue;
        const int step = edge.b.y > edge.a.y ? 1 : -1;
        if (orientation(edge.a, edge.b, p) == step) // p is to the left of the edge
            around += step;
    }
    return around;
}

} // namespace lamella
