#include "polygon/overhang.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/cells.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/box2.hpp"
#include "contour/distance.hpp"
#include "polygon/edge_tree.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <queue>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// A square in which the largest distance may be.
struct Square {
    Point2 centre;
    double half = 0;  ///< half of its side
    double bound = 0; ///< upper bound on the distances in it

    friend bool operator<(const Square& a, const Square& b) noexcept { return a.bound < b.bound; }
};

Layer layer_of_rings(const Layer& layer, const std::vector<std::size_t>& rings) {
    Layer some;
    std::vector<Point2> points;
    for (const std::size_t ring : rings) {
        points.insert(points.end(), layer.contour(ring).begin(), layer.contour(ring).end());
        some.offsets.push_back(points.size());
    }
    some.points = PointArray(std::move(points));
    some.rings = rings.size();
    return some;
}

/// Finds the largest distance of a point of some areas from the edges of `below`.
class FarthestPoint {
  public:
    explicit FarthestPoint(const Layer& below) : below_(below) {}

    /// Adds a connected area. Distances change by no more than the way between two points, so a square in
    /// which no distance can be larger than the largest is discarded; others are divided into four.
    void add(const Layer& area, double area_mm2) {
        double longest_edge = 0;
        double of_corners = 0;
        for (std::size_t ring = 0; ring < area.rings; ++ring) {
            Point2 last = area.contour(ring).back();
            for (const Point2& p : area.contour(ring)) {
                longest_edge = std::max(longest_edge, quick_distance(last, p));
                of_corners = std::max(of_corners, std::sqrt(below_.distance_squared(p, 0)));
                last = p;
            }
        }
        largest_ = std::max(largest_, of_corners);
        // No point is farther from the boundary than the radius of the circle that has this area.
        if (of_corners + longest_edge / 2 + std::sqrt(area_mm2 / std::numbers::pi) <= least_of_interest())
            return;
        const EdgeTree edges(area);
        const Box2 box = box_of(area.points);
        const double half = std::max(std::min(box.width(), box.height()) / 2,
                                     std::max(box.width(), box.height()) / most_squares);
        std::priority_queue<Square> squares;
        for (double x = box.x0 + half; x - half < box.x1; x += 2 * half)
            for (double y = box.y0 + half; y - half < box.y1; y += 2 * half)
                add_square({{x, y}, half}, edges, squares);
        while (!squares.empty() && squares.top().bound > least_of_interest()) {
            const Square square = squares.top();
            squares.pop();
            const double quarter = square.half / 2;
            for (const double x : {-quarter, quarter})
                for (const double y : {-quarter, quarter})
                    add_square({{square.centre.x + x, square.centre.y + y}, quarter}, edges, squares);
        }
    }

    [[nodiscard]] double distance() const noexcept { return largest_; }

  private:
    static constexpr double accuracy = 0.05;
    static constexpr double most_squares = 256; ///< along the longer side of a box

    [[nodiscard]] double least_of_interest() const noexcept { return largest_ * (1 + accuracy); }

    /// Keeps a square if it may have a point of the area that is farther away than the farthest so far.
    void add_square(Square square, const EdgeTree& edges, std::priority_queue<Square>& squares) {
        const double corner = square.half * std::sqrt(2.0);
        const bool inside = edges.winding(square.centre) > 0;
        if (!inside && edges.distance_squared(square.centre, corner * corner) > corner * corner)
            return;
        const double enough = std::max(0.0, least_of_interest() - corner);
        const double squared = below_.distance_squared(square.centre, enough * enough);
        if (squared <= enough * enough)
            return;
        const double distance = std::sqrt(squared);
        if (inside)
            largest_ = std::max(largest_, distance);
        square.bound = distance + corner;
        squares.push(square);
    }

    EdgeTree below_;
    double largest_ = 0;
};

} // namespace

Overhang overhang(const Layer& layer, const Layer& below, double reach_mm, double least_mm,
                  const LayerLimits& limits) {
    const Layer carried = offset(below, reach_mm, {.limits = limits});
    const LayerCells rest = cells_of(combine(layer, carried, BooleanOperation::subtract, limits), limits);
    std::vector<std::vector<std::size_t>> rings(rest.cells.size()); // of each body
    for (std::size_t ring = 0; ring < rest.layer.rings; ++ring)
        rings[rest.cells[ring + 1].material ? ring + 1 : rest.around[ring]].push_back(ring);
    Overhang found;
    std::optional<FarthestPoint> farthest;
    for (std::size_t cell = 1; cell < rest.cells.size(); ++cell) {
        if (!rest.cells[cell].material)
            continue;
        const Layer body = layer_of_rings(rest.layer, rings[cell]);
        if (rest.cells[cell].area_mm2 <= least_mm * measure(body).perimeter_mm / 2)
            continue;
        if (!farthest)
            farthest.emplace(below);
        farthest->add(body, rest.cells[cell].area_mm2);
        ++found.bodies;
        found.area_mm2 += rest.cells[cell].area_mm2;
    }
    if (farthest)
        found.width_mm = farthest->distance();
    return found;
}

} // namespace lamella
