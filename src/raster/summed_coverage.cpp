#include "raster/summed_coverage.hpp"

#include <algorithm>
#include <cstddef>

namespace lamella {

// The coverage of a pixel is a sum over all edges, in any order: each contributes the area between itself and
// the right end of the row, with the sign of its direction. Edges are visited in the order of the contours.
// Many consecutive edges may lie in one pixel; their sum is added to the row at once.

SummedRows::SummedRows(std::span<const Layer> parts, const PixelGrid& grid, const GreyValues& values)
    : bands_(parts, grid), width_(grid.width), height_(grid.height),
      downwards_(grid.ux * grid.vy > grid.uy * grid.vx ? -1 : 1),
      coverage_(grid.width, bands_.rows(), values) {}

DrawnRow SummedRows::draw(std::uint32_t row) {
    if (row == end_) {
        const std::uint32_t band = row / bands_.rows();
        top_ = row;
        end_ = std::min(top_ + bands_.rows(), height_);
        coverage_.clear_common();
        bands_.for_each_line(band, [this](std::span<const Point2> points) { add_line(points); });
    }
    std::uint32_t times = 1;
    if (coverage_.plain(row - top_))
        while (row + times < end_ && coverage_.plain(row + times - top_))
            ++times;
    const std::span<const PixelRun> runs = coverage_.take(row - top_);
    return {runs, coverage_.covered(), times, coverage_.unseen() * times};
}

void SummedRows::add_line(std::span<const Point2> points) {
    // The pixel that contains the previous point; empty if that point is outside of the image.
    double left = 0, right = 0, upper = 0, lower = 0;
    double weight = 0;
    double moment = 0;
    const auto enter = [&](const Point2& p) {
        if (p.x >= 0 && p.x < width_ && p.y >= top_ && p.y < end_) {
            left = static_cast<std::uint32_t>(p.x);
            upper = static_cast<std::uint32_t>(p.y);
            right = left + 1;
            lower = upper + 1;
        } else {
            right = left;
        }
    };
    const auto leave = [&] {
        if (weight != 0 || moment != 0)
            coverage_.begin_within(static_cast<std::uint32_t>(upper) - top_, static_cast<std::size_t>(left),
                                   weight, moment);
        weight = moment = 0;
    };
    enter(points.front());
    for (std::size_t i = 1; i < points.size(); ++i) {
        const Point2& p = points[i - 1];
        const Point2& q = points[i];
        if (q.x >= left && q.x < right && q.y >= upper && q.y < lower) {
            const double height = downwards_ * (q.y - p.y);
            weight += height;
            moment += height * (0.5 * (p.x + q.x) - left);
        } else {
            leave();
            if (p.y != q.y && std::min(p.x, q.x) < width_) {
                const ImageEdge edge(p, q);
                coverage_.begin_along(edge, top_, end_, downwards_ * edge.winding);
            }
            enter(q);
        }
    }
    leave();
}

} // namespace lamella
