#include "polygon/clipping_grid.hpp"

#include "lamella/core/error.hpp"

#include <algorithm>
#include <cmath>

namespace lamella {

ClippingGrid::ClippingGrid(std::span<const Point2> points, double margin) {
    if (points.empty())
        return;
    Point2 min = points.front();
    Point2 max = points.front();
    for (const Point2& p : points) {
        min = {std::min(min.x, p.x), std::min(min.y, p.y)};
        max = {std::max(max.x, p.x), std::max(max.y, p.y)};
    }
    const double extent = std::max(max.x - min.x, max.y - min.y) + 2 * margin;
    const double largest = std::max({std::abs(min.x), std::abs(min.y), std::abs(max.x), std::abs(max.y)});
    if (!(extent < 0x1p500 && largest < 0x1p500))
        throw Error(ErrorKind::limit, "a layer has coordinates beyond 1e150 mm, too large to unite contours");
    if (extent == 0)
        return;
    const int exponent = std::max({std::ilogb(extent) - 36, std::ilogb(largest) - 52, -500});
    unit_ = std::ldexp(1, exponent);
    origin_ = {std::nearbyint((min.x + (max.x - min.x) / 2) / unit_),
               std::nearbyint((min.y + (max.y - min.y) / 2) / unit_)};
}

Point2 ClippingGrid::place(const Point2& p) const noexcept {
    return {std::nearbyint(p.x / unit_ - origin_.x) + 0.0, std::nearbyint(p.y / unit_ - origin_.y) + 0.0};
}

} // namespace lamella
