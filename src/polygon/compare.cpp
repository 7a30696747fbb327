#include "lamella/polygon/compare.hpp"

#include "lamella/contour/normal_form.hpp"

#include "contour/same_height.hpp"
#include "polygon/edge_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

namespace lamella {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// How far the format may have moved a point of these layers.
double moved_points(const RoundedLayers& stack) {
    double most = 0;
    for (const Layer& layer : stack.layers)
        most = std::max(most, moved_point(layer.points.span(), stack.rounding));
    return most;
}

/// Pairs the layers of two stacks, which both ascend. `tolerance_mm`: of heights, beside rounding.
std::vector<ComparedPlane> paired(const RoundedLayers& first, const RoundedLayers& second,
                                  double tolerance_mm) {
    const auto z = [](const RoundedLayers& stack, std::size_t i) {
        return i < stack.layers.size() ? stack.layers[i].z : infinity;
    };
    const auto belong_together = [&](std::size_t i, std::size_t j) {
        if (i == first.layers.size() || j == second.layers.size())
            return false;
        const double apart = std::abs(z(first, i) - z(second, j));
        return apart <= moved_cut(first.layers[i], first.rounding) +
                            moved_cut(second.layers[j], second.rounding) + tolerance_mm &&
               apart <= std::abs(z(first, i + 1) - z(second, j)) &&
               apart <= std::abs(z(first, i) - z(second, j + 1));
    };
    std::vector<ComparedPlane> planes;
    for (std::size_t i = 0, j = 0; i < first.layers.size() || j < second.layers.size();) {
        ComparedPlane plane;
        const bool together = belong_together(i, j);
        const bool of_second = together || !(z(first, i) < z(second, j));
        const bool of_first = together || !of_second;
        const Layer& layer = of_first ? first.layers[i] : second.layers[j];
        plane.z = layer.z;
        if (of_first)
            plane.first = i++;
        if (of_second)
            plane.second = j++;
        if (together || layer.contours() > 0 || !layer.hatches.empty())
            planes.push_back(plane);
    }
    return planes;
}

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
    StackComparison result{
        .tolerance_mm = tolerance_mm ? *tolerance_mm : moved_points(first) + moved_points(second),
        .planes = paired(first, second, std::max(same_height_mm, tolerance_mm.value_or(0)))};
    bool any_pair = false;
    for (ComparedPlane& plane : result.planes) {
        if (!plane.first || !plane.second)
            continue;
        any_pair = true;
        plane.difference = compare(first.layers[*plane.first], second.layers[*plane.second]);
        plane.agree = plane.difference.within(result.tolerance_mm);
    }
    result.cut_apart = !any_pair && lowest_cut_apart(first, second);
    return result;
}

} // namespace lamella
