#pragma once

// Edges of contours by where they are: how far something is from them, and how they wind around it.

#include "lamella/contour/layer.hpp"

#include "polygon/box2.hpp"
#include "polygon/orientation.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

/// A balanced tree of boxes, split where the middles of edges are farthest apart.
class EdgeTree {
  public:
    /// All edges of a layer; a contour of one point is an edge of no length. O(n log n).
    explicit EdgeTree(const Layer& layer);

    [[nodiscard]] bool empty() const noexcept { return edges_.empty(); }

    /// The square of the distance to the nearest edge; where that is below `enough`, anything below it.
    /// Infinite where there are none.
    [[nodiscard]] double distance_squared(const Point2& p, double enough) const;
    /// The same from all of a segment: 0 where it meets an edge.
    [[nodiscard]] double distance_squared(const Segment& s, double enough) const;

    /// The nearest edge, from end to end. There is one.
    [[nodiscard]] std::pair<Point2, Point2> nearest(const Point2& p) const;

    /// How often the edges go around p, of rings alone. Exact; of a point on an edge counts what is above it,
    /// or to the right of it. It takes the edges to the right of p that it is beside.
    [[nodiscard]] std::int64_t winding(const Point2& p) const;

  private:
    struct Edge {
        Point2 a;
        Point2 b;

        [[nodiscard]] Point2 middle() const noexcept {
            return {a.x + (b.x - a.x) / 2, a.y + (b.y - a.y) / 2};
        }
    };
    struct Node {
        Box2 box;
        std::size_t begin;
        std::size_t end;
        std::size_t right; ///< the left child is the next node; 0: a leaf
    };

    void build(std::size_t begin, std::size_t end);
    [[nodiscard]] std::int64_t winding_below(std::size_t at, const Point2& p) const;
    template <class OfBox, class OfEdge>
    void search(std::size_t at, double enough, const OfBox& of_box, const OfEdge& of_edge,
                double& best) const;

    std::vector<Edge> edges_;
    std::vector<Node> nodes_;
};

} // namespace lamella
