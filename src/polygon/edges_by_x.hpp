#pragma once

// Edges of rings that may touch, coincide and cross: the edges below a point and their winding numbers.

#include "polygon/orientation.hpp"
#include "polygon/windings.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {

/// A non-vertical edge of a ring.
struct RingEdge {
    Segment line;
    std::uint32_t ring = 0; ///< a representative, see `RingCopies`
    Windings step;          ///< change of the winding numbers from below to above
    /// Orders coincident edges as if they were stacked: first rings that end at the edge, inner ones before
    /// those around them, then rings that begin there, outer ones first. Not negative if the inside of the
    /// ring is above.
    std::int64_t order = 0;
};

/// Edges that all span a common interval of x.
class EdgeColumn {
  public:
    void add(const RingEdge& edge) { ordered_.push_back(edge); }
    /// Sorts the edges. Call it once, after the last edge. All edges span x.
    void order(double x);

    [[nodiscard]] bool empty() const noexcept { return ordered_.empty() && loose_.empty(); }
    /// Returns the number of edges without an order; each query examines all of them.
    [[nodiscard]] std::size_t loose() const noexcept { return loose_.size(); }

    /// Returns the contribution of this column to the winding numbers below the edge at x.
    [[nodiscard]] Windings winding_below(double x, const RingEdge& edge) const;
    /// Raises `best` to the highest edge of this column below `edge`, if that is higher.
    void raise(double x, const RingEdge& edge, const RingEdge*& best) const;
    /// Returns the number of edges that coincide with `edge` to the right of x and have the same `order`.
    [[nodiscard]] std::int64_t count_equal(double x, const RingEdge& edge) const;

  private:
    [[nodiscard]] std::size_t first_not_below(double x, const RingEdge& edge) const;

    std::vector<RingEdge> ordered_; ///< from below to above
    std::vector<Windings> winding_; ///< above the first i of them
    std::vector<RingEdge> loose_;   ///< edges that cross others, in no order
};

/// A segment tree over values of x: each edge is kept in few nodes, and the nodes with the edges above and
/// below a point at one of these values are the ancestors of one leaf.
///
/// Neither the status of a sweep nor a grid could replace it. A query asks for the sum of the steps of all
/// edges below a point, where edges coincide and cross. A status knows the neighbours of an edge, and the sum
/// below it only as long as no edge is inserted or erased below, which coincident edges do between two
/// queries. A grid would add up edge by edge all the way down: for each of many nested rings, all rings
/// around it.
class EdgesByX {
  public:
    explicit EdgesByX(std::vector<double> abscissae);

    /// Returns the number of values below x; `near` is a guess.
    [[nodiscard]] std::size_t leaf(double x, std::size_t near) const;

    /// Adds an edge that spans the leaves [first, end).
    void add(const RingEdge& edge, std::size_t first, std::size_t end);
    /// Sorts all columns. Call it once, after the last edge.
    void order();

    /// Calls visit(column) for the columns with edges over x.
    template <class Visit>
    void for_columns_at(double x, const Visit& visit) const {
        for (std::size_t node = leaves_ + leaf(x, 0); node > 0; node /= 2)
            if (!nodes_[node].empty())
                visit(nodes_[node]);
    }

  private:
    std::vector<double> abscissae_;
    std::size_t leaves_ = 0;
    std::vector<EdgeColumn> nodes_; // node i has the children 2 i and 2 i + 1
};

} // namespace lamella
