#pragma once

// The cut graph: a node for every mesh edge that at least one plane cuts, linked to its successors. The graph
// contains every contour of every layer. The contours of a layer are found by following links, without any
// search.
//
// With consistent orientation, a contour leaves an edge through the same triangle on every plane that cuts
// the edge: the triangle in which the edge runs downwards, so that material is on the left. In that triangle
// the contour continues through one of the other two edges on planes below the middle vertex, and through the
// other one on planes above it. King, Rennie and Bennett (2021, section 3.2) already use the fact that two
// triangles remain neighbours along their whole edge; here each neighbour is searched for only once.

#include "lamella/mesh/indexed_mesh.hpp"
#include "lamella/mesh/triangle_soup.hpp"

#include "core/executor.hpp"
#include "core/pages.hpp"
#include "slicing/ranks.hpp"
#include "slicing/triangle_stream.hpp"

#include <cstdint>
#include <functional>

namespace lamella {

/// Stands for no successor: the contour ends, at a boundary of the mesh or at inconsistent orientation.
constexpr std::uint32_t no_node = 0xFFFFFFFF;

/// One cut edge. `Ends` identifies and locates its two end vertices, the lower one first.
///
/// On each plane i of its span, a contour passes through the edge and continues to the node next(i).
template <class Ends>
struct CutNode {
    std::uint32_t next_low;    ///< successor on planes below `split`; no_node if the contour ends
    std::uint32_t next_high;   ///< successor from plane `split` on
    std::uint32_t split;       ///< rank of the triangle's middle vertex, if there are two successors
    std::uint32_t triangle;    ///< triangle through which the contour leaves, if next_low is a node
    std::uint32_t last : 31;   ///< rank of the upper end; 0 if the node is not in use
    std::uint32_t entered : 1; ///< 1 if some node links to this one
    Ends ends;

    [[nodiscard]] std::uint32_t next(std::uint32_t plane) const noexcept {
        return plane < split ? next_low : next_high;
    }
    [[nodiscard]] bool left() const noexcept { return next_low != no_node; }
    [[nodiscard]] bool in_use() const noexcept { return last != 0; }
    /// Requires a number of 31 bits, as all planes have (lamella/slicing/plan.hpp).
    void set_last(std::uint32_t rank) noexcept { last = rank & 0x7FFFFFFF; }
};

/// The planes [first, last) that cut an edge, from the rank of its lower end to the rank of its upper end.
struct PlaneSpan {
    std::uint32_t first;
    std::uint32_t last;
};

/// The two ends of an edge. `Vertex` is the representation of a vertex in a kind of mesh.
template <class Vertex>
struct EdgeEnds {
    Vertex low, high;

    friend bool operator==(const EdgeEnds&, const EdgeEnds&) = default;
};

/// Ends in an STL file: the coordinates themselves. Equal coordinates are the same vertex, so an STL file is
/// sliced without a weld.
using FloatEnds = EdgeEnds<Point3f>;
/// Ends in a soup with a placement.
using DoubleEnds = EdgeEnds<Point3>;
/// Ends in an indexed mesh. Vertices are the same if and only if their indices are equal.
using IndexEnds = EdgeEnds<std::uint32_t>;

static_assert(sizeof(CutNode<FloatEnds>) == 44 && sizeof(CutNode<IndexEnds>) == 28);

template <class Ends>
struct CutGraph {
    /// Nodes, some of which are not in use.
    PageArray<CutNode<Ends>> nodes;
    /// Per node, for passes over all nodes; empty ([0, 0)) if the node is not in use.
    PageArray<PlaneSpan> spans;
    std::uint32_t count = 0;
    /// Vertices of an indexed mesh; must outlive the graph.
    const Point3* vertices = nullptr;
    /// Number of edges with more than two triangles, which were paired by geometry.
    std::uint64_t nonmanifold_edges = 0;

    [[nodiscard]] Point3 low(const Ends& ends) const noexcept { return point(ends.low); }
    [[nodiscard]] Point3 high(const Ends& ends) const noexcept { return point(ends.high); }

    /// Takes the node out of use.
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
/// equal corners are skipped. A non-manifold edge becomes one node for each pair of an arriving and a leaving
/// triangle. The pairs follow from the geometry around the edge, for any order of the triangles: each contour
/// bounds one wedge of material, and contours never cross there.
///
/// `visit`, if given, sees each triangle once, right before it is added: the triangles [begin, end), from any
/// thread.
///
/// Throws Error{limit} if the nodes cannot be numbered in 32 bits (about 2^32 / 3 triangles or more),
/// Error{cancelled}. Expected O(n) for n triangles, worst case O(n log n); parallel.
using RangeVisitor = std::function<void(std::uint64_t begin, std::uint64_t end)>;
[[nodiscard]] CutGraph<FloatEnds> build_cut_graph(const TriangleSoup& unplaced, const Ranks& ranks,
                                                  Executor& executor, ProgressMeter& progress,
                                                  const RangeVisitor& visit = {});
/// Builds the same graph from triangles that are not in memory.
[[nodiscard]] CutGraph<FloatEnds> build_cut_graph(const TriangleStream& unplaced, const Ranks& ranks,
                                                  Executor& executor, ProgressMeter& progress);
/// Builds the cut graph of a soup with a placement.
[[nodiscard]] CutGraph<DoubleEnds> build_placed_cut_graph(const TriangleSoup& soup, const Ranks& ranks,
                                                          Executor& executor, ProgressMeter& progress,
                                                          const RangeVisitor& visit = {});
[[nodiscard]] CutGraph<DoubleEnds> build_placed_cut_graph(const TriangleStream& stream, const Ranks& ranks,
                                                          Executor& executor, ProgressMeter& progress);
[[nodiscard]] CutGraph<IndexEnds> build_cut_graph(const IndexedMesh& mesh, const Ranks& ranks,
                                                  Executor& executor, ProgressMeter& progress,
                                                  const RangeVisitor& visit = {});

} // namespace lamella
