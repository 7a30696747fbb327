#include "write/page_bytes.hpp"

#include "lamella/contour/measure.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella {

namespace {

/// Appends points as the way from one to the next.
class Walk {
  public:
    Walk(GridPoint from, NumberBytes& out) : at_(from), out_(out) {}

    void to(const GridPoint& p) {
        out_.add_signed(p.x - at_.x);
        out_.add_signed(p.y - at_.y);
        at_ = p;
    }

  private:
    GridPoint at_;
    NumberBytes& out_;
};

/// Contours on the grid, one after the other in one array.
struct SnappedContours {
    std::vector<GridPoint> points;
    std::vector<std::size_t> ends;
    std::size_t rings = 0;
};

SnappedContours snapped(const Layer& layer, bool vectors, const WriterGrid& grid) {
    SnappedContours result;
    std::vector<GridPoint> scratch;
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const bool closed = layer.closed(i);
        const auto contour = layer.contour(i);
        std::span<const GridPoint> points;
        if (vectors)
            points = scratch = grid.snap_points(contour, layer.index);
        else
            points = grid.snap(contour, closed, closed ? ring_area(contour) : 0, layer.index, scratch);
        if (points.empty())
            continue;
        result.points.insert(result.points.end(), points.begin(), points.end());
        result.ends.push_back(result.points.size());
        result.rings += closed ? 1 : 0;
    }
    return result;
}

void add_contours(const SnappedContours& contours, GridPoint origin, NumberBytes& out) {
    GridPoint first = origin;
    std::size_t begin = 0;
    for (const std::size_t end : contours.ends) {
        out.add(end - begin);
        Walk walk(first, out);
        first = contours.points[begin];
        for (; begin < end; ++begin)
            walk.to(contours.points[begin]);
    }
}

} // namespace

double page_step_mm(const Box3& box) {
    constexpr double steps = 50000;
    const double least = std::max(box.max.x - box.min.x, box.max.y - box.min.y) / steps;
    if (!(least > 0) || !std::isfinite(least))
        return 0.001;
    const double decade = std::pow(10, std::floor(std::log10(least)));
    // The last one is for a logarithm that was rounded up.
    for (const double digit : {1.0, 2.0, 5.0})
        if (digit * decade >= least)
            return digit * decade;
    return 10 * decade;
}

PageGrid page_grid(const Box3& box) {
    PageGrid grid{.step_mm = page_step_mm(box), .origin = {}};
    const Point2 corner{box.min.x, box.min.y};
    grid.origin = WriterGrid(grid.step_mm).snap_points({&corner, 1}, 0).front();
    return grid;
}

NumberBytes layer_numbers(std::span<const Layer> layers, std::span<const PartInfo> parts,
                          std::span<const Point2> places, const PageGrid& grid, std::uint64_t& shown) {
    const WriterGrid snapping(grid.step_mm);
    NumberBytes out;
    shown = 0;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const Layer& layer = layers[i];
        const SnappedContours contours = snapped(layer, parts[i].exposure.has_value(), snapping);
        out.add(contours.rings);
        out.add(contours.ends.size() - contours.rings);
        out.add(layer.hatches.size() / 2);
        add_contours(contours, grid.origin, out);
        Walk walk(grid.origin, out);
        for (const GridPoint& p : snapping.snap_points(layer.hatches.span(), layer.index))
            walk.to(p);
        shown += contours.points.size();
    }
    out.add(places.size());
    Walk walk(grid.origin, out);
    for (const GridPoint& p : snapping.snap_points(places, layers.empty() ? 0 : layers.front().index))
        walk.to(p);
    return out;
}

} // namespace lamella
