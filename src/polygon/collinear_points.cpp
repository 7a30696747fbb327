#include "polygon/collinear_points.hpp"

#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

Point2 between(const Point2& a, const Point2& b) noexcept {
    return {b.x - a.x, b.y - a.y};
}

double dot(const Point2& v, const Point2& w) noexcept {
    return v.x * w.x + v.y * w.y;
}

double cross(const Point2& v, const Point2& w) noexcept {
    return v.x * w.y - v.y * w.x;
}

/// A straight segment between two points; the points between them are removed.
class Way {
  public:
    Way(const Point2& from, const Point2& to) : from_(from), to_(to) {}

    [[nodiscard]] const Point2& to() const noexcept { return to_; }

    /// Extends the segment to p if the segment stays straight, and removes its former end. Returns whether
    /// this was done.
    bool go_on_to(const Point2& p, double tolerance) noexcept {
        const Point2 v = between(from_, to_);
        const Point2 w = between(from_, p);
        const double off = cross(v, w);
        const double square = dot(v, v);
        if (!(off * off <= tolerance * tolerance * dot(w, w) && dot(v, w) > square))
            return false;
        if (left_out_ && (cross(right_, w) < 0 || cross(w, left_) < 0))
            return false;
        // Limits of direction, to the right and to the left, beyond which the end would be too far away.
        const double shift = tolerance / std::sqrt(square);
        const Point2 right{v.x + shift * v.y, v.y - shift * v.x};
        const Point2 left{v.x - shift * v.y, v.y + shift * v.x};
        if (!left_out_ || cross(right_, right) > 0)
            right_ = right;
        if (!left_out_ || cross(left, left_) > 0)
            left_ = left;
        left_out_ = true;
        to_ = p;
        return true;
    }

  private:
    Point2 from_;
    Point2 to_;
    bool left_out_ = false;
    Point2 right_; ///< limits of the direction, due to the points that were removed
    Point2 left_;
};

/// Appends the ring without its collinear points, or unchanged if too few points would remain.
void put_ring(std::span<const Point2> ring, double tolerance, std::vector<Point2>& out) {
    const std::size_t begin = out.size();
    out.push_back(ring[0]);
    Way way(ring[0], ring[1]);
    for (std::size_t i = 2; i <= ring.size(); ++i) {
        const Point2& next = ring[i < ring.size() ? i : 0];
        if (!way.go_on_to(next, tolerance)) {
            out.push_back(way.to());
            way = Way(way.to(), next);
        }
    }
    if (out.size() - begin < 3) {
        out.resize(begin);
        out.insert(out.end(), ring.begin(), ring.end());
    }
}

} // namespace

Layer remove_collinear_points(const Layer& layer, double tolerance) {
    if (!(tolerance > 0x1p-200 && tolerance < 0x1p100))
        return layer;
    std::vector<Point2> points;
    points.reserve(layer.points.size());
    Layer result = layer;
    result.offsets.assign(1, 0);
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const std::span<const Point2> contour = layer.contour(i);
        if (layer.closed(i) && contour.size() > 3)
            put_ring(contour, tolerance, points);
        else
            points.insert(points.end(), contour.begin(), contour.end());
        result.offsets.push_back(points.size());
    }
    assert(points.size() <= layer.points.size());
    if (points.size() == layer.points.size())
        return layer;
    result.points = PointArray(std::move(points));
    return result;
}

} // namespace lamella
