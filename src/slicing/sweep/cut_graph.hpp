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
#include "slicing/sweep/edge_ends.hpp"

#include <cstdint>
#include <functional>
#include <utility>

namespace lamella {

/// Stands for no successor: the contour ends, at a boundary of the mesh or at inconsistent orientation.
constexpr std::uint32_t no_node = 0xFFFFFFFF;

/// One cut edge.
///
/// On each plane i of [first, last), a contour passes through the edge and continues to the node next(i).
struct CutNode {
    std::uint32_t next_low;  ///< successor on planes below `split`; no_node if the contour ends
    std::uint32_t next_high; ///< successor from plane `split` on
    std::uint32_t split;     ///< rank of the triangle's middle vertex, if there are two successors
    /// The edge as a side of a triangle, 3 t + i for the side of triangle t that begins at its corner i. If
    /// next_low is a node, the contour leaves through this triangle.
    std::uint32_t side;
    std::uint32_t first;       ///< rank of the lower end
    std::uint32_t last : 31;   ///< rank of the upper end; 0 if the node is not in use
    std::uint32_t entered : 1; ///< 1 if some node links to this one

    [[nodiscard]] std::uint32_t next(std::uint32_t plane) const noexcept {
        return plane < split ? next_low : next_high;
    }
    [[nodiscard]] std::uint32_t triangle() const noexcept { return side / 3; }
    [[nodiscard]] bool left() const noexcept { return next_low != no_node; }
    [[nodiscard]] bool in_use() const noexcept { return last != 0; }
    /// Requires a number of 31 bits, as all planes have (lamella/slicing/plan.hpp).
    void set_last(std::uint32_t rank) noexcept { last = rank & 0x7FFFFFFF; }
};

static_assert(sizeof(CutNode) == 24);

struct CutGraph {
    /// Nodes, some of which are not in use.
    PageArray<CutNode> nodes;
    std::uint32_t count = 0;
    /// Number of edges with more than two triangles, which were paired by geometry.
    std::uint64_t nonmanifold_edges = 0;
};

/// A cut graph and the ends of its edges. `Ends` is one of the classes of edge_ends.hpp.
template <class Ends>
struct LocatedGraph : CutGraph {
    using Vertex = typename Ends::Vertex;

    explicit LocatedGraph(Ends of_edges) : ends(std::move(of_edges)) {}

    /// Returns the vertices at both ends of the edge.
    [[nodiscard]] EdgeEnds<Vertex> vertices(std::uint32_t id) const noexcept {
        const auto [a, b] = ends(nodes[id].side);
        return ends.point(a).z < ends.point(b).z ? EdgeEnds<Vertex>{a, b} : EdgeEnds<Vertex>{b, a};
    }

    /// Returns the coordinates of both ends of the edge.
    [[nodiscard]] EdgeEnds<Point3> points(std::uint32_t id) const noexcept {
        const auto [a, b] = ends(nodes[id].side);
        const Point3 p = ends.point(a);
        const Point3 q = ends.point(b);
        return p.z < q.z ? EdgeEnds<Point3>{p, q} : EdgeEnds<Point3>{q, p};
    }

    Ends ends;
};

/// Builds the cut graph in one pass over the triangles. Triangles that no plane cuts and triangles with two
/// equal corners are skipped. A non-manifold edge becomes one node for each pair of an arriving and a leaving
/// triangle. The pairs follow from the geometry around the edge, for any order of the triangles: each contour
/// bounds one wedge of material, and contours never cross there. The graph keeps a soup; an indexed mesh
/// must outlive the graph.
///
/// If `visit` is given, it is called for each range of triangles [begin, end), from any thread, right before
/// they are added.
///
/// Throws Error{limit} if the nodes cannot be numbered in 32 bits (about 2^32 / 3 triangles or more),
/// Error{cancelled}. Expected O(n) for n triangles, worst case O(n log n); parallel.
using RangeVisitor = std::function<void(std::uint64_t begin, std::uint64_t end)>;
[[nodiscard]] LocatedGraph<SoupEnds> build_cut_graph(const TriangleSoup& unplaced, const Ranks& ranks,
                                                     Executor& executor, ProgressMeter& progress,
                                                     const RangeVisitor& visit = {});
/// Builds the cut graph of a soup with a placement.
[[nodiscard]] LocatedGraph<PlacedEnds> build_placed_cut_graph(const TriangleSoup& soup, const Ranks& ranks,
                                                              Executor& executor, ProgressMeter& progress,
                                                              const RangeVisitor& visit = {});
[[nodiscard]] LocatedGraph<IndexedEnds> build_cut_graph(const IndexedMesh& mesh, const Ranks& ranks,
                                                        Executor& executor, ProgressMeter& progress,
                                                        const RangeVisitor& visit = {});

} // namespace lamella
