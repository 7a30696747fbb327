#pragma once

// Edges of rings that may touch, coincide and cross: which are below a place, and how they wind around it.

#include "polygon/orientation.hpp"
#include "polygon/windings.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {

/// An edge of a ring that is not vertical.
struct RingEdge {
    Segment line;
    std::uint32_t ring = 0; ///< a representative, see `RingCopies`
    Windings step;          ///< how they change from below to above
    /// Orders edges that coincide, as if they lay upon one another: rings that end at the edge first, the
    /// inner ones before those around them, then rings that begin there, the outer ones first. Not negative
    /// where the ring's inside is above.
    std::int64_t order = 0;
};

/// Edges that all reach from one abscissa to another one and beyond.
class EdgeColumn {
  public:
    void add(const RingEdge& edge) { ordered_.push_back(edge); }
    /// To be called once, after the last edge; x is an abscissa that all reach over.
    void order(double x);

    [[nodiscard]] bool empty() const noexcept { return ordered_.empty() && loose_.empty(); }
    /// How many edges have no order: each question looks at all of these.
    [[nodiscard]] std::size_t loose() const noexcept { return loose_.size(); }

    /// The windings below the edge at x, as far as this column has a part in them.
    [[nodiscard]] Windings winding_below(double x, const RingEdge& edge) const;
    /// Makes `best` the highest edge below `edge`, if that is higher than it.
    void raise(double x, const RingEdge& edge, const RingEdge*& best) const;
    /// How many edges coincide with `edge`, to the right of x, and have its place in that order.
    [[nodiscard]] std::int64_t count_equal(double x, const RingEdge& edge) const;

  private:
    [[nodiscard]] std::size_t first_not_below(double x, const RingEdge& edge) const;

    std::vector<RingEdge> ordered_; ///< from below to above
    std::vector<Windings> winding_; ///< above the first i of them
    std::vector<RingEdge> loose_;   ///< those that cross others, in no order
};

/// A segment tree over some abscissae: each edge is kept in few nodes, and those with the edges above and
/// below a place at one of the abscissae are the ancestors of one leaf.
///
/// Why neither the status of a sweep nor a grid takes its place. A question is for the sum of the steps of
/// all edges below a place, where edges coincide and cross. A status knows its neighbours, and the sum below
/// an edge only as long as no edge is put in or taken out below it, which edges that lie upon one another do
/// between two questions. A grid would sum up edge by edge all the way down, for each of many rings within
/// one another all of those around it.
class EdgesByX {
  public:
    explicit EdgesByX(std::vector<double> abscissae);

    /// The number of abscissae below x; `near` is a guess.
    [[nodiscard]] std::size_t leaf(double x, std::size_t near) const;

    /// Adds an edge that reaches over the leaves [first, end).
    void add(const RingEdge& edge, std::size_t first, std::size_t end);
    /// To be called once, after the last edge.
    void order();

    /// Calls visit(column) for the columns with edges over the abscissa x.
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
