#pragma once

// The cut graph: every mesh edge that at least one plane cuts, linked to its successors. It holds every
// contour of every layer; a layer's contours are read off by following links, without any search.
//
// The thought: with consistent orientation a contour leaves an edge, on every plane that cuts it, through the
// same triangle: the one in which the edge runs downwards (so that material is on the left). Of that
// triangle's two other edges one leads on below the middle vertex and the other one above it. King, Rennie
// and Bennett (2021, section 3.2) use that a neighbour once found stays the neighbour along the edge; here it
// is found once and for all.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "slicing/ranks.hpp"

#include <cstdint>
#include <functional>

namespace lamella {

/// No node: the mesh ends here (a boundary, or orientation that does not fit).
constexpr std::uint32_t no_node = 0xFFFFFFFF;

/// One cut edge; `Ends` identifies and locates its two end vertices, the lower one first.
///
/// On plane i of its span a contour runs through the edge, and on to the node next(i).
template <class Ends>
struct CutNode {
    std::uint32_t next_low;    ///< the successor on planes below `split`; no_node where the contour ends
    std::uint32_t next_high;   ///< the successor from plane `split` on
    std::uint32_t split;       ///< the rank of the triangle's middle vertex, where there are two successors
    std::uint32_t triangle;    ///< that the contour leaves through; meaningful when next_low is a node
    std::uint32_t last : 31;   ///< the rank of the upper end; 0 in a node that is not in use
    std::uint32_t entered : 1; ///< some node leads here
    Ends ends;

    [[nodiscard]] std::uint32_t next(std::uint32_t plane) const noexcept {
        return plane < split ? next_low : next_high;
    }
    [[nodiscard]] bool left() const noexcept { return next_low != no_node; }
    [[nodiscard]] bool in_use() const noexcept { return last != 0; }
    /// Planes are numbered in 31 bits (lamella/slicing/plan.hpp).
    void set_last(std::uint32_t rank) noexcept { last = rank & 0x7FFFFFFF; }
};

/// The planes [first, last) that cut an edge: from the rank of its lower end to that of its upper one.
struct PlaneSpan {
    std::uint32_t first;
    std::uint32_t last;
};

/// The two ends of an edge, as a kind of mesh knows its vertices.
template <class Vertex>
struct EdgeEnds {
    Vertex low, high;

    friend bool operator==(const EdgeEnds&, const EdgeEnds&) = default;
};

/// Of an STL file: the coordinates themselves. Equal coordinates are the same vertex, so no weld is needed on
/// the way from an STL file to layers.
using FloatEnds = EdgeEnds<Point3f>;
/// The same for a soup with a placement.
using DoubleEnds = EdgeEnds<Point3>;
/// Of an indexed mesh, whose sharing is taken at its word.
using IndexEnds = EdgeEnds<std::uint32_t>;

static_assert(sizeof(CutNode<FloatEnds>) == 44 && sizeof(CutNode<IndexEnds>) == 28);

template <class Ends>
struct CutGraph {
    /// Some of the nodes in [0, count) are not in use.
    PageArray<CutNode<Ends>> nodes;
    /// Per node, for those who look at all of them; empty ([0, 0)) where it is not in use.
    PageArray<PlaneSpan> spans;
    std::uint32_t count = 0;
    /// Of an indexed mesh; must outlive the graph.
    const Point3* vertices = nullptr;
    /// Edges with more than two triangles, which were paired by geometry.
    std::uint64_t nonmanifold_edges = 0;

    [[nodiscard]] Point3 low(const Ends& ends) const noexcept { return point(ends.low); }
    [[nodiscard]] Point3 high(const Ends& ends) const noexcept { return point(ends.high); }

    /// The node is in use no longer.
    void drop(std::uint32_t id) const noexcept {
        nodes[id].last = 0;
        spans[id] = {0, 0};
    }

  private:
    [[nodiscard]] Point3 point(const Point3f& p) const noexcept { return {p.x, p.y, p.z}; }
    [[nodiscard]] Point3 point(const Point3& p) const noexcept { return p; }
    [[nodiscard]] Point3 point(std::uint32_t vertex) const noexcept { return vertices[vertex]; }
};

/// Builds the cut graph in one pass over the triangles. Triangles that no plane cuts and triangles with two
/// equal corners are dropped on sight. An edge with more than one triangle on a side (non-manifold) becomes
/// one node for each pair of an arriving and a leaving triangle; they are paired by their geometry around the
/// edge, so that contours bound one wedge of material each and never cross there, whatever the order of the
/// triangles.
///
/// `visit`, where there is one, sees the triangles [begin, end) right before they are added, each once and
/// from any thread.
///
/// Expected O(triangles), parallel; a hostile file costs O(n log n). Throws Error{limit} when the nodes
/// cannot be numbered in 32 bits (beyond 2^32 / 3 triangles), Error{cancelled}.
using RangeVisitor = std::function<void(std::uint64_t begin, std::uint64_t end)>;
[[nodiscard]] CutGraph<FloatEnds> build_cut_graph(const TriangleSoup& unplaced, const Ranks& ranks,
                                                  Executor& executor, ProgressMeter& progress,
                                                  const RangeVisitor& visit = {});
/// For a soup with a placement.
[[nodiscard]] CutGraph<DoubleEnds> build_placed_cut_graph(const TriangleSoup& soup, const Ranks& ranks,
                                                          Executor& executor, ProgressMeter& progress,
                                                          const RangeVisitor& visit = {});
[[nodiscard]] CutGraph<IndexEnds> build_cut_graph(const IndexedMesh& mesh, const Ranks& ranks,
                                                  Executor& executor, ProgressMeter& progress,
                                                  const RangeVisitor& visit = {});

} // namespace lamella
