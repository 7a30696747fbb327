#pragma once

// A tree of contour edges: distances from them, and their winding numbers.

#include "lamella/contour/layer.hpp"

#include "contour/box2.hpp"
#include "polygon/orientation.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

/// A balanced tree of boxes, split along the axis on which the midpoints of edges spread most.
class EdgeTree {
  public:
    /// Builds the tree of all edges of a layer; a contour of one point is an edge of length 0. O(n log n).
    explicit EdgeTree(const Layer& layer);

    [[nodiscard]] bool empty() const noexcept { return edges_.empty(); }

    /// Returns the squared distance from p to the nearest edge; if this is below `enough`, any value below
    /// `enough`. Infinite if there are no edges.
    [[nodiscard]] double distance_squared(const Point2& p, double enough) const;
    /// Returns the same for the distance from a segment: 0 if the segment meets an edge.
    [[nodiscard]] double distance_squared(const Segment& s, double enough) const;

    /// Returns the ends of the nearest edge. Requires at least one edge.
    [[nodiscard]] std::pair<Point2, Point2> nearest(const Point2& p) const;

    /// Returns the winding number of the edges around p; requires rings only. Exact. A point on a horizontal
    /// edge counts as just above it, a point on any other edge as just to its right. Examines the edges to
    /// the right of p at its y.
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
        std::size_t right; ///< the left child is the next node; 0 for a leaf
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
