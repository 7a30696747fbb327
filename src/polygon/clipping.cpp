#include "polygon/clipping.hpp"

#include <polyclipping/clipper.hpp>

#include <utility>

namespace lamella {

std::vector<Ring> grown(std::span<const std::span<const Point2>> rings, double distance,
                        const ClippingGrid& grid) {
    constexpr double miter_limit = 2;
    ClipperLib::ClipperOffset offset(miter_limit);
    for (const std::span<const Point2> ring : rings) {
        ClipperLib::Path path;
        path.reserve(ring.size());
        for (const Point2& p : ring) {
            const Point2 place = grid.place(p);
            path.emplace_back(static_cast<ClipperLib::cInt>(place.x), static_cast<ClipperLib::cInt>(place.y));
        }
        offset.AddPath(path, ClipperLib::jtMiter, ClipperLib::etClosedPolygon);
    }
    ClipperLib::Paths result;
    offset.Execute(result, distance / grid.unit());
    std::vector<Ring> grown;
    grown.reserve(result.size());
    for (const ClipperLib::Path& path : result) {
        Ring ring;
        ring.reserve(path.size());
        for (const ClipperLib::IntPoint& p : path)
            ring.push_back(grid.point({static_cast<double>(p.X), static_cast<double>(p.Y)}));
        grown.push_back(std::move(ring));
    }
    return grown;
}

} // namespace lamella
