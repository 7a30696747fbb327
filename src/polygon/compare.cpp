#include "lamella/polygon/compare.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "contour/area_moments.hpp"
#include "contour/box2.hpp"
#include "contour/distance.hpp"
#include "contour/same_height.hpp"
#include "core/executor.hpp"
#include "polygon/compared_planes.hpp"
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

StackPlanes planes_of(const RoundedLayers& stack) {
    StackPlanes planes{stack.layers, stack.rounding, {}};
    for (const Layer& layer : stack.layers)
        planes.drawn.push_back(layer.contours() > 0);
    return planes;
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

void check_tolerance(std::optional<double> tolerance_mm) {
    if (tolerance_mm && !(*tolerance_mm >= 0))
        throw Error(
            ErrorKind::usage,
            fmt::format("layers cannot be compared within {} mm; it must be 0 or more", *tolerance_mm));
}

std::vector<ComparedPlane> paired(const StackPlanes& first, const StackPlanes& second,
                                  std::optional<double> tolerance_mm) {
    const double allowed = std::max(same_height_mm, tolerance_mm.value_or(0));
    const auto z = [](const StackPlanes& stack, std::size_t i) {
        return i < stack.planes.size() ? stack.planes[i].z : infinity;
    };
    const auto belong_together = [&](std::size_t i, std::size_t j) {
        if (i == first.planes.size() || j == second.planes.size())
            return false;
        const double apart = std::abs(z(first, i) - z(second, j));
        return apart <= moved_cut(first.planes[i], first.rounding) +
                            moved_cut(second.planes[j], second.rounding) + allowed &&
               apart <= std::abs(z(first, i + 1) - z(second, j)) &&
               apart <= std::abs(z(first, i) - z(second, j + 1));
    };
    std::vector<ComparedPlane> pairs;
    for (std::size_t i = 0, j = 0; i < first.planes.size() || j < second.planes.size();) {
        ComparedPlane plane;
        const bool together = belong_together(i, j);
        const bool of_second = together || !(z(first, i) < z(second, j));
        const bool of_first = together || !of_second;
        plane.z = of_first ? z(first, i) : z(second, j);
        const bool drawn = of_first ? first.drawn[i] : second.drawn[j];
        if (of_first)
            plane.first = i++;
        if (of_second)
            plane.second = j++;
        if (together || drawn)
            pairs.push_back(plane);
    }
    return pairs;
}

void compare_layers(ComparedPlane& plane, const Layer& first, const Layer& second, double tolerance_mm) {
    LayerDifference& difference = plane.difference;
    if (plane.first && plane.second) {
        difference = compare_beyond(first, second, tolerance_mm);
        plane.agree = difference.within(tolerance_mm);
    } else if (plane.first) {
        difference.first = measure(first);
    } else {
        difference.second = measure(second);
    }
}

bool are_cut_apart(const StackPlanes& first, const StackPlanes& second,
                   std::span<const ComparedPlane> pairs) {
    if (first.planes.empty() || second.planes.empty() ||
        std::any_of(pairs.begin(), pairs.end(),
                    [](const ComparedPlane& plane) { return plane.first && plane.second; }))
        return false;
    const Layer& one = first.planes.front();
    const Layer& other = second.planes.front();
    const double rounding = moved_cut(one, first.rounding) + moved_cut(other, second.rounding);
    return one.z != other.z && std::abs(one.bottom - other.bottom) <= rounding &&
           std::abs(one.top - other.top) <= rounding;
}

StackComparison compare(const RoundedLayers& first, const RoundedLayers& second,
                        std::optional<double> tolerance_mm, const Execution& execution) {
    check_tolerance(tolerance_mm);
    const StackPlanes planes[2] = {planes_of(first), planes_of(second)};
    StackComparison result{.tolerance_mm =
                               tolerance_mm ? *tolerance_mm : moved_points(first) + moved_points(second),
                           .planes = paired(planes[0], planes[1], tolerance_mm)};
    const auto layer_of = [](const RoundedLayers& stack, std::optional<std::size_t> i) -> const Layer& {
        static const Layer none;
        return i ? stack.layers[*i] : none;
    };
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::polygon, result.planes.size());
    executor.for_chunks(result.planes.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        ComparedPlane& plane = result.planes[i];
        compare_layers(plane, layer_of(first, plane.first), layer_of(second, plane.second),
                       result.tolerance_mm);
        progress.add(1);
    });
    progress.finish();
    result.cut_apart = are_cut_apart(planes[0], planes[1], result.planes);
    return result;
}

} // namespace lamella
