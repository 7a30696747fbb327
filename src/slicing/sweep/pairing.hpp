#pragma once

// Non-manifold edges: pairs each arriving triangle with a leaving one.
//
// Seen from above, the traces of the triangles of such an edge are rays around a point. A contour arrives
// along one ray and leaves along another with the material on its left. Counter-clockwise, a leaving ray
// therefore opens a wedge of material and an arriving ray closes one. They are matched like brackets: an
// arriving ray is paired with the nearest open leaving ray before it. Wedges of separate bodies that touch in
// the edge stay separate, and no two contours cross there.

#include "slicing/sweep/cut_graph.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstring>
#include <functional>
#include <initializer_list>
#include <tuple>
#include <vector>

namespace lamella {

namespace pairing {

/// The trace of one triangle at the edge.
struct Ray {
    bool arrives;
    float angle;            ///< monotone in the true angle, in [4, 8); rounded, so that coplanar rays tie
    Point3 third;           ///< the triangle's corner that is not on the edge
    std::uint32_t triangle; ///< distinguishes identical triangles
    std::uint32_t node;     ///< arriving: the node it arrives at; leaving: index of the links it follows
};

/// Returns the angle of the direction from the edge to the third corner, projected along the edge into a
/// horizontal plane.
inline float ray_angle(const Point3& low, const Point3& high, const Point3& third) {
    // Scaling by powers of two changes no digit. Without it, differences of coordinates above 1e154 and their
    // products overflow to NaN, which cannot be sorted. Heights have a scale of their own, so that a flat and
    // wide mesh does not vanish.
    const double largest =
        std::max({std::abs(low.x), std::abs(low.y), std::abs(low.z), std::abs(high.x), std::abs(high.y),
                  std::abs(high.z), std::abs(third.x), std::abs(third.y), std::abs(third.z)});
    const double shrink = largest > 0x1p1000 ? 0x1p-4 : 1;
    const auto gap = [shrink](double from, double to) {
        return to * shrink - from * shrink;
    };
    const auto bring_near_one = [](std::initializer_list<double*> numbers) {
        double most = 0;
        for (const double* number : numbers)
            most = std::max(most, std::abs(*number));
        if (most > 0)
            for (double* number : numbers)
                *number = std::scalbn(*number, -std::ilogb(most));
    };
    double dz = gap(low.z, high.z);
    double up = gap(low.z, third.z);
    bring_near_one({&dz, &up});
    double edge_x = gap(low.x, high.x);
    double edge_y = gap(low.y, high.y);
    double third_x = gap(low.x, third.x);
    double third_y = gap(low.y, third.y);
    bring_near_one({&edge_x, &edge_y, &third_x, &third_y});
    const double x = third_x * dz - up * edge_x;
    const double y = third_y * dz - up * edge_y;
    const double size = std::abs(x) + std::abs(y);
    if (!(size > 0))
        return 4; // all three corners are collinear: there is no direction
    const double slope = x / size;
    // Floats in [4, 8) are too coarse to show rounding errors of the angle. An angle that is below the full
    // turn only by such an error becomes the first angle.
    const auto angle = static_cast<float>(y >= 0 ? 5 - slope : 7 + slope);
    return angle < 8 ? angle : 4;
}

/// Orders rays counter-clockwise. At the same angle wedges close before others open, and identical triangles
/// nest, so that every copy of a duplicated body is linked to itself.
inline bool before(const Ray& a, const Ray& b) {
    if (a.angle != b.angle)
        return a.angle < b.angle;
    if (a.arrives != b.arrives)
        return a.arrives;
    const auto key = [](const Ray& r) {
        return std::tuple(r.third.x, r.third.y, r.third.z, r.triangle);
    };
    return a.arrives ? key(b) < key(a) : key(a) < key(b);
}

/// Returns the pairs (arriving, leaving) as indices into the sorted rays. Unpaired rays are omitted.
inline std::vector<std::pair<std::size_t, std::size_t>> match(const std::vector<Ray>& rays) {
    std::vector<std::pair<std::size_t, std::size_t>> pairs;
    std::vector<std::size_t> open;
    std::vector<std::size_t> unmatched;
    for (std::size_t i = 0; i < rays.size(); ++i) {
        if (!rays[i].arrives) {
            open.push_back(i);
        } else if (!open.empty()) {
            pairs.emplace_back(i, open.back());
            open.pop_back();
        } else {
            unmatched.push_back(i);
        }
    }
    // A second pass pairs wedges that contain the angle zero.
    for (const std::size_t i : unmatched) {
        if (open.empty())
            break;
        pairs.emplace_back(i, open.back());
        open.pop_back();
    }
    assert(open.empty() ||
           std::count_if(rays.begin(), rays.end(), std::mem_fn(&Ray::arrives)) == std::ssize(pairs));
    return pairs;
}

} // namespace pairing

/// Assigns new links to nodes with equal ends. `non_manifold` must contain every such node at least once;
/// nodes not in use are ignored. Returns the number of non-manifold edges. O(nodes of the graph + c log c)
/// for c nodes in `non_manifold`; only called if there are any.
template <class Ends>
std::uint64_t pair_non_manifold_edges(LocatedGraph<Ends>& graph, std::vector<std::uint32_t> non_manifold,
                                      Executor& executor) {
    using pairing::Ray;
    using Edge = EdgeEnds<typename Ends::Vertex>;

    const auto ends_order = [&](std::uint32_t a, std::uint32_t b) {
        const Edge of_a = graph.vertices(a);
        const Edge of_b = graph.vertices(b);
        return std::memcmp(&of_a, &of_b, sizeof(Edge));
    };
    std::sort(non_manifold.begin(), non_manifold.end(), [&](std::uint32_t a, std::uint32_t b) {
        const int order = ends_order(a, b);
        return order != 0 ? order < 0 : a < b;
    });
    non_manifold.erase(std::unique(non_manifold.begin(), non_manifold.end()), non_manifold.end());
    executor.check_cancelled();

    const auto third = [&](const Edge& edge, std::uint32_t beside) {
        const Edge other = graph.vertices(beside);
        const bool low_is_shared = other.low == edge.low || other.low == edge.high;
        return graph.ends.point(low_is_shared ? other.high : other.low);
    };

    // The triangle that arrives at a node is stored in the node that links to it: one pass over all nodes
    // finds it.
    std::vector<bool> is_non_manifold(graph.count);
    for (const std::uint32_t id : non_manifold)
        is_non_manifold[id] = true;
    struct Arrival {
        std::uint32_t node;
        std::uint32_t from;
        std::uint32_t triangle;
    };
    std::vector<std::vector<Arrival>> found(executor.workers());
    executor.for_chunks(graph.count, 1U << 16, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
        for (std::uint64_t id = begin; id < end; ++id) {
            const CutNode& node = graph.nodes[id];
            if (!node.in_use() || !node.left())
                continue;
            for (const std::uint32_t next : {node.next_low, node.next_high})
                if (is_non_manifold[next])
                    found[worker].push_back({next, static_cast<std::uint32_t>(id), node.triangle()});
        }
    });
    std::vector<Arrival> arrivals;
    for (std::vector<Arrival>& part : found) {
        arrivals.insert(arrivals.end(), part.begin(), part.end());
        part = std::vector<Arrival>(); // frees the memory
    }
    const auto by_node = [](const Arrival& a, const Arrival& b) {
        return a.node < b.node;
    };
    executor.check_cancelled();
    std::sort(arrivals.begin(), arrivals.end(), by_node);

    std::uint64_t edges = 0;
    std::vector<Ray> rays;
    std::vector<CutNode> links;
    for (std::size_t begin = 0; begin < non_manifold.size();) {
        if (edges % 1024 == 0)
            executor.check_cancelled();
        std::size_t end = begin + 1;
        while (end < non_manifold.size() && ends_order(non_manifold[begin], non_manifold[end]) == 0)
            ++end;

        const Edge edge = graph.vertices(non_manifold[begin]);
        const EdgeEnds<Point3> ends = graph.points(non_manifold[begin]);
        std::uint32_t first = 0; // the planes that cut the edge
        std::uint32_t last = 0;
        rays.clear();
        links.clear();
        std::vector<std::uint32_t> spare; // nodes without an arriving contour, for the unpaired links
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t id = non_manifold[i];
            CutNode& node = graph.nodes[id];
            if (node.in_use()) {
                first = node.first;
                last = node.last;
            }
            if (node.left()) {
                rays.push_back({false, 0, third(edge, node.next_low), node.triangle(),
                                static_cast<std::uint32_t>(links.size())});
                links.push_back(node);
            }
            if (node.entered) {
                const auto arrival =
                    std::lower_bound(arrivals.begin(), arrivals.end(), Arrival{id, 0, 0}, by_node);
                assert(arrival != arrivals.end() && arrival->node == id);
                rays.push_back({true, 0, third(edge, arrival->from), arrival->triangle, id});
            } else {
                spare.push_back(id);
            }
            node.next_low = node.next_high = no_node;
        }
        for (Ray& ray : rays)
            ray.angle = pairing::ray_angle(ends.low, ends.high, ray.third);
        std::sort(rays.begin(), rays.end(), pairing::before);

        std::vector<bool> placed(links.size());
        const auto position = [&](std::uint32_t node, std::uint32_t link) {
            assert(!placed[link]);
            const CutNode& from = links[link];
            CutNode& to = graph.nodes[node];
            to.next_low = from.next_low;
            to.next_high = from.next_high;
            to.split = from.split;
            to.side = from.side;
            to.first = first;
            to.set_last(last);
            placed[link] = true;
        };
        for (const auto& [arriving, leaving] : pairing::match(rays))
            position(rays[arriving].node, rays[leaving].node);
        for (std::uint32_t link = 0; link < links.size(); ++link) {
            if (!placed[link]) {
                assert(!spare.empty()); // each unpaired link came with such a node
                position(spare.back(), link);
                spare.pop_back();
            }
        }
        for (const std::uint32_t id : spare)
            graph.nodes[id].last = 0;
        edges += rays.size() > 2;
        begin = end;
    }
    return edges;
}

} // namespace lamella
