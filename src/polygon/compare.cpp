#include "lamella/polygon/compare.hpp"

#include "lamella/contour/normal_form.hpp"

#include "polygon/edge_tree.hpp"

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

/// How far the format may have moved a point of these layers.
double moved_points(const RoundedLayers& stack) {
    double most = 0;
    for (const Layer& layer : stack.layers)
        most = std::max(most, moved_point(layer, stack.rounding));
    return most;
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
void farthest(const Layer& from, const EdgeTree& to, double& largest, Point2& where) {
    for (const Point2& p : from.points) {
        const double distance = to.empty() ? infinity : to.distance_squared(p, largest);
        if (distance > largest) {
            largest = distance;
            where = p;
        }
    }
}

/// Whether the lowest layers lie between the same heights and are not cut at the same one.
bool lowest_cut_apart(const RoundedLayers& first, const RoundedLayers& second) {
    if (first.layers.empty() || second.layers.empty())
        return false;
    const Layer& one = first.layers.front();
    const Layer& other = second.layers.front();
    const double rounding = moved_cut(one, first.rounding) + moved_cut(other, second.rounding);
    return one.z != other.z && std::abs(one.bottom - other.bottom) <= rounding &&
           std::abs(one.top - other.top) <= rounding;
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
    farthest(first, EdgeTree(second), largest, difference.where);
    farthest(second, EdgeTree(first), largest, difference.where);
    difference.distance_mm = std::sqrt(largest);
    return difference;
}

StackComparison compare(const RoundedLayers& first, const RoundedLayers& second,
                        std::optional<double> tolerance_mm) {
    StackComparison result{.tolerance_mm =
                               tolerance_mm ? *tolerance_mm : moved_points(first) + moved_points(second),
                           .planes = PlanePairs(first, second).take()};
    bool paired = false;
    for (ComparedPlane& plane : result.planes) {
        if (!plane.first || !plane.second)
            continue;
        paired = true;
        plane.difference = compare(first.layers[*plane.first], second.layers[*plane.second]);
        plane.agree = plane.difference.within(result.tolerance_mm);
    }
    result.cut_apart = !paired && lowest_cut_apart(first, second);
    return result;
}

} // namespace lamella
