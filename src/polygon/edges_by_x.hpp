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
    /// Orders coincident edges from below to above. First come edges of rings whose inside is below, inner
    /// rings before the rings around them; then edges of rings whose inside is above, outer rings first.
    /// Negative if the inside of the ring is below.
    std::int64_t order = 0;
};

/// Edges that all span a common interval of x.
class EdgeColumn {
  public:
    void add(const RingEdge& edge) { ordered_.push_back(edge); }
    /// Sorts the edges, all of which must span x. Must be called once, after the last edge is added.
    void order(double x);

    [[nodiscard]] bool empty() const noexcept { return ordered_.empty() && loose_.empty(); }
    /// Returns the number of edges that cross others and thus have no order. Each query examines all of them.
    [[nodiscard]] std::size_t loose() const noexcept { return loose_.size(); }

    /// Returns the contribution of this column to the winding numbers below the edge at x.
    [[nodiscard]] Windings winding_below(double x, const RingEdge& edge) const;
    /// Sets `best` to the highest edge of this column below `edge`, if that is higher than `best`.
    void raise(double x, const RingEdge& edge, const RingEdge*& best) const;
    /// Returns the number of edges that coincide with `edge` to the right of x and have the same `order`.
    [[nodiscard]] std::int64_t count_equal(double x, const RingEdge& edge) const;

  private:
    [[nodiscard]] std::size_t first_not_below(double x, const RingEdge& edge) const;

    std::vector<RingEdge> ordered_; ///< from below to above
    std::vector<Windings> winding_; ///< winding numbers above the first i edges
    std::vector<RingEdge> loose_;   ///< edges that cross others, in no particular order
};

/// A segment tree over values of x. Each edge is stored in few nodes. The edges over one of these values of x
/// are the edges in the ancestors of one leaf.
///
/// Neither a sweep status nor a grid could replace the tree. A query needs the sum of the steps of all edges
/// below a point, where edges coincide and cross. A status provides the neighbours of an edge. The sum below
/// an edge is valid only until another edge is inserted or erased below it, which happens between two queries
/// if edges coincide. With a grid, edges would be added one by one from the point downwards. For each of many
/// nested rings, these would be the edges of all rings around it.
class EdgesByX {
  public:
    explicit EdgesByX(std::vector<double> abscissae);

    /// Returns the number of values below x; `near` is a guess.
    [[nodiscard]] std::size_t leaf(double x, std::size_t near) const;

    /// Adds an edge that spans the leaves [first, end).
    void add(const RingEdge& edge, std::size_t first, std::size_t end);
    /// Sorts all columns. Must be called once, after the last edge is added.
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
