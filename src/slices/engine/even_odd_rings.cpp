#include "slices/engine/even_odd_rings.hpp"

#include "lamella/contour/measure.hpp"

#include <algorithm>
#include <cstdint>

namespace lamella {

namespace {

/// Largest number of edges that are compared with a point.
constexpr std::uint64_t most_comparisons = std::uint64_t{1} << 28;

Box3 box_of_ring(std::span<const Point2> ring) {
    Box3 box;
    for (const Point2& p : ring)
        box.add(Point3{p.x, p.y, 0});
    return box;
}

bool reaches(const Box3& box, const Point2& p) {
    return box.min.x <= p.x && p.x <= box.max.x && box.min.y <= p.y && p.y <= box.max.y;
}

/// Returns whether the ring runs around the point: a ray to the right crosses it an odd number of times.
bool encloses(std::span<const Point2> ring, const Point2& p) {
    bool inside = false;
    const Point2* from = &ring.back();
    for (const Point2& to : ring) {
        if ((from->y > p.y) != (to.y > p.y)) {
            const double side = (to.x - from->x) * (p.y - from->y) - (p.x - from->x) * (to.y - from->y);
            if ((to.y > from->y) == (side > 0))
                inside = !inside;
        }
        from = &to;
    }
    return inside;
}

/// Returns a point of a ring that is on no vertex of another ring of a usual drawing: the middle of an edge.
Point2 middle_of_edge(std::span<const Point2> ring) {
    return {ring[0].x + (ring[1].x - ring[0].x) / 2, ring[0].y + (ring[1].y - ring[0].y) / 2};
}

} // namespace

std::optional<std::size_t> direct_by_even_odd(std::span<const std::span<Point2>> rings) {
    std::vector<Box3> boxes;
    for (const std::span<Point2> ring : rings)
        boxes.push_back(box_of_ring(ring));
    std::uint64_t comparisons = 0;
    std::vector<bool> in_others(rings.size()); // in an odd number of them
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const Point2 point = middle_of_edge(rings[i]);
        comparisons += rings.size();
        for (std::size_t k = 0; k < rings.size(); ++k) {
            if (k == i || !reaches(boxes[k], point))
                continue;
            comparisons += rings[k].size();
            if (comparisons > most_comparisons)
                return std::nullopt;
            in_others[i] = in_others[i] != encloses(rings[k], point);
        }
        if (comparisons > most_comparisons)
            return std::nullopt;
    }
    std::size_t reversed = 0;
    for (std::size_t i = 0; i < rings.size(); ++i) {
        const double area = ring_area(rings[i]);
        if (area == 0 || (area < 0) == in_others[i])
            continue;
        std::reverse(rings[i].begin(), rings[i].end());
        ++reversed;
    }
    return reversed;
}

} // namespace lamella
