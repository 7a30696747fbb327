#include "polygon/clipping_grid.hpp"

#include "lamella/core/error.hpp"

#include "contour/box2.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

ClippingGrid::ClippingGrid(std::span<const Point2> points, double margin)
    : ClippingGrid(points, margin, -500) {}

ClippingGrid ClippingGrid::of_integers(std::span<const Point2> points) {
    return {points, 0, 0};
}

ClippingGrid::ClippingGrid(std::span<const Point2> points, double margin, int least_exponent) {
    if (points.empty())
        return;
    const Box2 box = box_of(points);
    const double extent = std::max(box.width(), box.height()) + 2 * margin;
    const double largest = box.largest_coordinate();
    if (!(extent < 0x1p500 && largest < 0x1p500))
        throw Error(ErrorKind::limit, "a layer has coordinates beyond 1e150 mm, too large to unite contours");
    if (extent == 0)
        return;
    const int exponent = std::max({std::ilogb(extent) - 36, std::ilogb(largest) - 52, least_exponent});
    unit_ = std::ldexp(1, exponent);
    origin_ = {std::nearbyint((box.x0 + box.width() / 2) / unit_),
               std::nearbyint((box.y0 + box.height() / 2) / unit_)};
}

Point2 ClippingGrid::position(const Point2& p) const noexcept {
    return {std::nearbyint(p.x / unit_ - origin_.x) + 0.0, std::nearbyint(p.y / unit_ - origin_.y) + 0.0};
}

} // namespace lamella
