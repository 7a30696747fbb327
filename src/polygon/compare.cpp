#include "lamella/polygon/compare.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "contour/area_moments.hpp"
#include "contour/distance.hpp"
#include "contour/same_height.hpp"
#include "core/executor.hpp"
#include "polygon/box2.hpp"
#include "polygon/edge_tree.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

namespace lamella {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

/// Returns the largest distance by which the format may have moved a point of these layers.
double moved_points(const RoundedLayers& stack) {
    double most = 0;
    for (const Layer& layer : stack.layers)
        most = std::max(most, moved_point(layer.points.span(), stack.rounding));
    return most;
}

/// Pairs the layers of two stacks in ascending z. `tolerance_mm` is added to the rounding of heights.
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
        const RoundedLayers& stack = of_first ? first : second;
        const std::size_t position = of_first ? *plane.first : *plane.second;
        const bool hatched = !stack.hatch_lines.empty() && stack.hatch_lines[position] > 0;
        if (together || layer.contours() > 0 || hatched)
            planes.push_back(plane);
    }
    return planes;
}

/// Raises `largest` to the largest squared distance from a corner of `from` to the contours of the other
/// layer, if that distance is larger.
void farthest(const Layer& from, const EdgeTree& to, double& largest, Point2& where) {
    for (const Point2& p : from.points) {
        const double distance = to.empty() ? infinity : to.distance_squared(p, largest);
        if (distance > largest) {
            largest = distance;
            where = p;
        }
    }
}

/// Does the same for all points of an edge, with a relative accuracy of a thousandth.
void farthest(const Point2& a, const Point2& b, const EdgeTree& to, double& largest, Point2& where) {
    const Point2 middle{a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2};
    const auto [s, t] = to.nearest(middle);
    // Along an edge, the distance from another edge is a convex function, so it is largest at the ends.
    if (std::max(distance_squared(a, s, t), distance_squared(b, s, t)) <= 1.002 * largest)
        return;
    const double squared = distance_squared(middle, s, t);
    if (squared > largest) {
        largest = squared;
        where = middle;
    }
    if (middle == a || middle == b || !(squared < infinity))
        return;
    farthest(a, middle, to, largest, where);
    farthest(middle, b, to, largest, where);
}

void farthest_between_corners(const Layer& from, const EdgeTree& to, double& largest, Point2& where) {
    for (std::size_t i = 0; i < from.contours(); ++i) {
        const auto contour = from.contour(i);
        for (std::size_t k = 1; k < contour.size(); ++k)
            farthest(contour[k - 1], contour[k], to, largest, where);
        if (from.closed(i) && !contour.empty())
            farthest(contour.back(), contour.front(), to, largest, where);
    }
}

/// Returns the area that would have to move across the box of both layers to cause their difference of first
/// moments.
double displaced(const Layer& first, const Layer& second, const Box2& box) {
    const Point2 middle{box.x0 + box.width() / 2, box.y0 + box.height() / 2};
    const AreaMoments one = area_moments(first, middle);
    const AreaMoments other = area_moments(second, middle);
    const auto per = [](double moment, double width) {
        return width > 0 ? std::abs(moment) / width : 0;
    };
    return std::max(per(one.x_mm3 - other.x_mm3, box.width()), per(one.y_mm3 - other.y_mm3, box.height()));
}

/// Compares two layers. Distances up to the tolerance are measured at corners only.
LayerDifference compare_beyond(const Layer& first, const Layer& second, double tolerance_mm) {
    LayerDifference difference;
    difference.same = same_contours(first, second);
    difference.first = measure(first);
    difference.second = difference.same ? difference.first : measure(second);
    if (difference.same)
        return difference;
    const EdgeTree first_edges(first);
    const EdgeTree second_edges(second);
    double largest = 0;
    farthest(first, second_edges, largest, difference.where);
    farthest(second, first_edges, largest, difference.where);
    if (!first_edges.empty() && !second_edges.empty()) {
        Box2 box = box_of(first.points);
        box.add(box_of(second.points));
        const double least = std::max(tolerance_mm, 0x1p-36 * box.largest_coordinate()); // rounding errors
        const double known = std::max(largest, least * least);
        double between = known;
        farthest_between_corners(first, second_edges, between, difference.where);
        farthest_between_corners(second, first_edges, between, difference.where);
        if (between > known)
            largest = between;
        difference.displaced_mm2 = displaced(first, second, box);
    }
    difference.distance_mm = std::sqrt(largest);
    return difference;
}

/// Returns whether the lowest layers have the same bottom and top but are cut at different heights.
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
           std::abs(first.area_mm2 - second.area_mm2) <= moved && displaced_mm2 <= moved;
}

LayerDifference compare(const Layer& first, const Layer& second) {
    return compare_beyond(first, second, 0);
}

StackComparison compare(const RoundedLayers& first, const RoundedLayers& second,
                        std::optional<double> tolerance_mm, const Execution& execution) {
    if (tolerance_mm && !(*tolerance_mm >= 0))
        throw Error(
            ErrorKind::usage,
            fmt::format("layers cannot be compared within {} mm; it must be 0 or more", *tolerance_mm));
    StackComparison result{
        .tolerance_mm = tolerance_mm ? *tolerance_mm : moved_points(first) + moved_points(second),
        .planes = paired(first, second, std::max(same_height_mm, tolerance_mm.value_or(0)))};
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::polygon, result.planes.size());
    executor.for_chunks(result.planes.size(), 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        for (std::uint64_t i = begin; i < end; ++i) {
            ComparedPlane& plane = result.planes[i];
            LayerDifference& difference = plane.difference;
            if (plane.first && plane.second) {
                difference = compare_beyond(first.layers[*plane.first], second.layers[*plane.second],
                                            result.tolerance_mm);
                plane.agree = difference.within(result.tolerance_mm);
            } else if (plane.first) {
                difference.first = measure(first.layers[*plane.first]);
            } else {
                difference.second = measure(second.layers[*plane.second]);
            }
            progress.add(1);
        }
    });
    progress.finish();
    const bool any_pair = std::any_of(result.planes.begin(), result.planes.end(),
                                      [](const ComparedPlane& plane) { return plane.first && plane.second; });
    result.cut_apart = !any_pair && lowest_cut_apart(first, second);
    return result;
}

} // namespace lamella
