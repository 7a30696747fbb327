#include "lamella/contour/layer.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"

#include "contour/same_height.hpp"
#include "core/bit_cast.hpp"
#include "core/farthest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

namespace lamella {

PointArray::PointArray(std::vector<Point2> points) {
    const auto shared = std::make_shared<const std::vector<Point2>>(std::move(points));
    points_ = *shared;
    owner_ = shared;
}

namespace {

/// Compares absolute values as integers, which ascend with them, NaN beyond all: no branches, and several
/// numbers at a time.
bool any_too_far(std::span<const Point2> points) {
    constexpr std::uint64_t farthest = lamella::bit_cast<std::uint64_t>(farthest_mm);
    constexpr std::uint64_t absolute = ~(std::uint64_t{1} << 63);
    std::uint64_t below_0 = 0;
    for (const Point2& p : points)
        below_0 |= (farthest - (lamella::bit_cast<std::uint64_t>(p.x) & absolute)) |
                   (farthest - (lamella::bit_cast<std::uint64_t>(p.y) & absolute));
    return (below_0 >> 63) != 0;
}

[[noreturn]] void refuse(const Layer& layer, const std::string& thing, double length) {
    throw Error(ErrorKind::usage,
                fmt::format("layer {}, {}: found {}; coordinates must be finite and within {} mm",
                            layer.index, thing, length, farthest_mm));
}

void refuse_first_of(std::span<const Point2> points, const Layer& layer, const std::string& thing) {
    for (const Point2& p : points)
        if (is_too_far(p.x) || is_too_far(p.y))
            refuse(layer, thing, is_too_far(p.x) ? p.x : p.y);
}

} // namespace

void check(const Layer& layer) {
    const std::vector<std::uint64_t>& offsets = layer.offsets;
    const bool divided = offsets.empty() ? layer.points.empty()
                                         : offsets.front() == 0 && offsets.back() == layer.points.size() &&
                                               std::is_sorted(offsets.begin(), offsets.end());
    if (!divided || layer.rings > layer.contours())
        throw Error(ErrorKind::usage,
                    fmt::format("layer {}: its offsets do not divide {} points into {} rings and further "
                                "chains; they must ascend from 0 to the number of points",
                                layer.index, layer.points.size(), layer.rings));
    for (const double height : {layer.z, layer.bottom, layer.top})
        if (is_too_far(height))
            refuse(layer, "its heights", height);
    if (any_too_far(layer.points.span()))
        for (std::size_t i = 0; i < layer.contours(); ++i)
            refuse_first_of(layer.contour(i), layer, fmt::format("contour {}", i));
}

void Plane::add(Layer lines, PointArray hatch_lines) {
    polylines.push_back(std::move(lines));
    hatches.push_back(std::move(hatch_lines));
    image.reset();
    cuts.clear();
}

void Plane::append(Plane other) {
    std::move(other.polylines.begin(), other.polylines.end(), std::back_inserter(polylines));
    std::move(other.hatches.begin(), other.hatches.end(), std::back_inserter(hatches));
    image.reset();
    cuts.clear();
}

void check(const Plane& plane) {
    if (plane.polylines.size() != plane.hatches.size())
        throw Error(ErrorKind::usage,
                    fmt::format("a plane has polylines of {} parts and hatch lines of {}; each part has both",
                                plane.polylines.size(), plane.hatches.size()));
    for (std::size_t i = 0; i < plane.parts(); ++i) {
        const Layer& layer = plane.polylines[i];
        const PointArray& hatches = plane.hatches[i];
        check(layer);
        if (const Layer& first = plane.polylines.front(); !on_same_plane(first, layer))
            throw Error(
                ErrorKind::usage,
                fmt::format("part {} of a plane has layer {} at z = {} mm (from {} to {}), and the first "
                            "part has layer {} at {} (from {} to {})",
                            i + 1, layer.index, layer.z, layer.bottom, layer.top, first.index, first.z,
                            first.bottom, first.top));
        if (hatches.size() % 2 != 0)
            throw Error(ErrorKind::usage,
                        fmt::format("layer {} has {} points of hatch lines; each line has two", layer.index,
                                    hatches.size()));
        if (any_too_far(hatches.span()))
            refuse_first_of(hatches.span(), layer, "its hatches");
    }
}

void LayerBuilder::end_contour(bool closed) {
    const std::size_t begin = ends_.empty() ? 0 : ends_.back().offset;
    if (points_.size() > begin)
        ends_.push_back({points_.size(), closed});
}

void LayerBuilder::add_contour(std::span<const Point2> points, bool closed) {
    for (const Point2& p : points)
        add_point(p);
    end_contour(closed);
}

Layer LayerBuilder::finish(std::uint64_t index, double z, double bottom, double top) {
    return normal_form(finish_as_added(index, z, bottom, top));
}

Layer LayerBuilder::finish_as_added(std::uint64_t index, double z, double bottom, double top) {
    const std::vector<End> ends = std::exchange(ends_, {});
    std::vector<Point2> points = std::exchange(points_, {});
    points.resize(ends.empty() ? 0 : ends.back().offset); // drops a contour that was never ended

    Layer layer{.index = index, .z = z, .bottom = bottom, .top = top};
    layer.offsets.reserve(ends.size() + 1);
    layer.rings = static_cast<std::size_t>(
        std::count_if(ends.begin(), ends.end(), [](const End& e) { return e.closed; }));
    const bool rings_first =
        std::is_partitioned(ends.begin(), ends.end(), [](const End& e) { return e.closed; });
    if (rings_first) {
        for (const End& end : ends)
            layer.offsets.push_back(end.offset);
    } else {
        std::vector<Point2> sorted;
        sorted.reserve(points.size());
        for (const bool closed : {true, false}) {
            std::size_t begin = 0;
            for (const End& end : ends) {
                if (end.closed == closed) {
                    sorted.insert(sorted.end(), points.begin() + static_cast<std::ptrdiff_t>(begin),
                                  points.begin() + static_cast<std::ptrdiff_t>(end.offset));
                    layer.offsets.push_back(sorted.size());
                }
                begin = end.offset;
            }
        }
        points = std::move(sorted);
    }
    assert(layer.contours() == ends.size() && layer.offsets.back() == points.size());
    layer.points = PointArray(std::move(points));
    return layer;
}

} // namespace lamella
