#include "lamella/polygon/compare.hpp"

#include "lamella/contour/normal_form.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace lamella {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct ContourEdge {
    Point2 a;
    Point2 b;
};

double distance_squared(const Point2& p, const ContourEdge& s) {
    const double dx = s.b.x - s.a.x;
    const double dy = s.b.y - s.a.y;
    const double length = dx * dx + dy * dy;
    const double along = length > 0 ? ((p.x - s.a.x) * dx + (p.y - s.a.y) * dy) / length : 0;
    const double t = std::clamp(along, 0.0, 1.0);
    const double x = p.x - (s.a.x + t * dx);
    const double y = p.y - (s.a.y + t * dy);
    return x * x + y * y;
}

/// The nearest of many segments: a balanced tree of boxes, split by the middles of segments along the longer
/// side of each box.
class NearestSegment {
  public:
    explicit NearestSegment(const Layer& layer) {
        segments_.reserve(layer.points.size());
        for (std::size_t i = 0; i < layer.contours(); ++i) {
            const auto contour = layer.contour(i);
            for (std::size_t k = 1; k < contour.size(); ++k)
                segments_.push_back({contour[k - 1], contour[k]});
            if (layer.closed(i) || contour.size() == 1)
                segments_.push_back({contour.back(), contour.front()});
        }
        if (!segments_.empty())
            build(0, segments_.size());
    }

    [[nodiscard]] bool empty() const { return segments_.empty(); }

    /// The square of the distance to the nearest one; where that is below `enough`, anything below it.
    [[nodiscard]] double operator()(const Point2& p, double enough) const {
        double best = infinity;
        search(0, p, enough, best);
        return best;
    }

  private:
    static constexpr std::size_t leaf = 8;

    struct Node {
        Point2 least{infinity, infinity};
        Point2 most{-infinity, -infinity};
        std::size_t begin = 0;
        std::size_t end = 0;
        std::size_t right = 0; ///< the left child is the next node; 0: a leaf

        [[nodiscard]] double distance_squared(const Point2& p) const {
            const double dx = std::max({least.x - p.x, 0.0, p.x - most.x});
            const double dy = std::max({least.y - p.y, 0.0, p.y - most.y});
            return dx * dx + dy * dy;
        }
    };

    void build(std::size_t begin, std::size_t end) {
        const std::size_t at = nodes_.size();
        nodes_.push_back({.begin = begin, .end = end});
        Node& node = nodes_.back();
        for (std::size_t i = begin; i < end; ++i)
            for (const Point2& p : {segments_[i].a, segments_[i].b}) {
                node.least = {std::min(node.least.x, p.x), std::min(node.least.y, p.y)};
                node.most = {std::max(node.most.x, p.x), std::max(node.most.y, p.y)};
            }
        if (end - begin <= leaf)
            return;
        const bool along_x = node.most.x - node.least.x >= node.most.y - node.least.y;
        const std::size_t middle = begin + (end - begin) / 2;
        const auto place = [&](std::size_t i) {
            return segments_.begin() + static_cast<std::ptrdiff_t>(i);
        };
        std::nth_element(place(begin), place(middle), place(end),
                         [&](const ContourEdge& s, const ContourEdge& t) {
                             return along_x ? s.a.x + s.b.x < t.a.x + t.b.x : s.a.y + s.b.y < t.a.y + t.b.y;
                         });
        build(begin, middle);
        nodes_[at].right = nodes_.size();
        build(middle, end);
    }

    void search(std::size_t at, const Point2& p, double enough, double& best) const {
        const Node& node = nodes_[at];
        if (node.right == 0) {
            for (std::size_t i = node.begin; i < node.end; ++i)
                best = std::min(best, lamella::distance_squared(p, segments_[i]));
            return;
        }
        std::size_t near = at + 1;
        std::size_t far = node.right;
        double to_near = nodes_[near].distance_squared(p);
        double to_far = nodes_[far].distance_squared(p);
        if (to_far < to_near) {
            std::swap(near, far);
            std::swap(to_near, to_far);
        }
        if (to_near < best)
            search(near, p, enough, best);
        if (best > enough && to_far < best)
            search(far, p, enough, best);
    }

    std::vector<ContourEdge> segments_;
    std::vector<Node> nodes_;
};

/// How far the format may have moved a point of these layers.
double moved_points(const RoundedLayers& stack) {
    double largest = 0;
    for (const Layer& layer : stack.layers)
        for (const Point2& p : layer.points)
            largest = std::max({largest, std::abs(p.x), std::abs(p.y)});
    return stack.rounding.step_at(largest) / 2 * std::sqrt(2.0);
}

/// Pairs the layers of two stacks, which both ascend.
class PlanePairs {
  public:
    PlanePairs(const RoundedLayers& first, const RoundedLayers& second) : first_(first), second_(second) {
        std::size_t i = 0;
        std::size_t j = 0;
        while (i < first.layers.size() || j < second.layers.size()) {
            if (belong_together(i, j)) {
                planes_.push_back({first.layers[i].z, i, j});
                ++i;
                ++j;
            } else if (z(first, i) < z(second, j)) {
                add_alone(first.layers[i], i, {});
                ++i;
            } else {
                add_alone(second.layers[j], {}, j);
                ++j;
            }
        }
    }

    [[nodiscard]] std::vector<ComparedPlane> take() { return std::move(planes_); }

  private:
    [[nodiscard]] static double z(const RoundedLayers& stack, std::size_t i) {
        return i < stack.layers.size() ? stack.layers[i].z : infinity;
    }

    [[nodiscard]] bool belong_together(std::size_t i, std::size_t j) const {
        if (i == first_.layers.size() || j == second_.layers.size())
            return false;
        constexpr double of_arithmetic = 1e-9; // a cut half-way up is computed
        const double apart = std::abs(z(first_, i) - z(second_, j));
        return apart <= moved_cut(first_.layers[i], first_.rounding) +
                            moved_cut(second_.layers[j], second_.rounding) + of_arithmetic &&
               apart <= std::abs(z(first_, i + 1) - z(second_, j)) &&
               apart <= std::abs(z(first_, i) - z(second_, j + 1));
    }

    void add_alone(const Layer& layer, std::optional<std::size_t> in_first,
                   std::optional<std::size_t> in_second) {
        if (layer.contours() > 0)
            planes_.push_back({layer.z, in_first, in_second});
    }

    const RoundedLayers& first_;
    const RoundedLayers& second_;
    std::vector<ComparedPlane> planes_;
};

/// The largest way from a corner of `from` to the contours of the other, where it is larger than what was
/// found before.
void farthest(const Layer& from, const NearestSegment& to, double& largest, Point2& where) {
    for (const Point2& p : from.points) {
        const double distance = to.empty() ? infinity : to(p, largest);
        if (distance > largest) {
            largest = distance;
            where = p;
        }
    }
}

} // namespace

bool LayerDifference::within(double tolerance_mm) const noexcept {
    if (same)
        return true;
    const double rounding = 1e-12 * (std::abs(first.area_mm2) + std::abs(second.area_mm2));
    const double moved = tolerance_mm * (first.perimeter_mm + second.perimeter_mm) + rounding;
    return distance_mm <= tolerance_mm && first.open_chains == second.open_chains &&
           std::abs(first.area_mm2 - second.area_mm2) <= moved;
}

LayerDifference compare(const Layer& first, const Layer& second) {
    LayerDifference difference;
    if (same_contours(first, second)) {
        difference.same = true;
        return difference;
    }
    difference.first = measure(first);
    difference.second = measure(second);
    double largest = 0;
    farthest(first, NearestSegment(second), largest, difference.where);
    farthest(second, NearestSegment(first), largest, difference.where);
    difference.distance_mm = std::sqrt(largest);
    return difference;
}

StackComparison compare(const RoundedLayers& first, const RoundedLayers& second,
                        std::optional<double> tolerance_mm) {
    StackComparison result{.tolerance_mm =
                               tolerance_mm ? *tolerance_mm : moved_points(first) + moved_points(second),
                           .planes = PlanePairs(first, second).take()};
    for (ComparedPlane& plane : result.planes) {
        if (!plane.first || !plane.second)
            continue;
        plane.difference = compare(first.layers[*plane.first], second.layers[*plane.second]);
        plane.agree = plane.difference.within(result.tolerance_mm);
    }
    return result;
}

} // namespace lamella
