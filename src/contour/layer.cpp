#include "lamella/contour/layer.hpp"

#include "lamella/contour/normal_form.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

namespace lamella {

PointArray::PointArray(std::vector<Point2> points) {
    const auto shared = std::make_shared<const std::vector<Point2>>(std::move(points));
    points_ = *shared;
    owner_ = shared;
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
    points.resize(ends.empty() ? 0 : ends.back().offset); // a contour that was never ended is none

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
