#pragma once

// Edges with more than two triangles: which arriving triangle goes with which leaving one.
//
// Around such an edge, seen from above, lie the traces of its triangles as rays. A contour arrives along one
// ray and leaves along another with the material on its left. So going counter-clockwise a leaving ray opens
// a wedge of material and an arriving ray closes one: like brackets, an arrival is paired with the nearest
// open leaving ray before it. Wedges of separate bodies that touch in the edge stay separate, and no two
// contours cross there.

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
    Point3 third;           ///< the triangle's corner off the edge
    std::uint32_t triangle; ///< tells identical triangles apart
    std::uint32_t node;     ///< arriving: that the contour arrives at; leaving: whose links it follows
};

/// The direction from the edge to the third corner, projected along the edge into a horizontal plane.
inline float ray_angle(const Point3& low, const Point3& high, const Point3& third) {
    // Scaled by powers of two, which changes no digit: else differences, and products of them, of coordinates
    // above 1e154 overflow to a NaN, which has no place in an order. Heights have a scale of their own, so
    // that a flat and wide mesh does not vanish.
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
        return 4; // all three corners on a line: no direction
    const double slope = x / size;
    // Far from 0, where floats would tell rounding errors apart; and what lies just before the whole turn, by
    // such an error, is where it begins.
    const auto angle = static_cast<float>(y >= 0 ? 5 - slope : 7 + slope);
    return angle < 8 ? angle : 4;
}

/// Counter-clockwise; at the same angle wedges close before others open, and identical triangles nest, so
/// that every copy of a duplicated body is linked to itself.
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

/// The pairs (arriving, leaving) as indices into the sorted rays; what stays over is left out.
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
    // Once more around: wedges that lie across the angle zero.
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

/// Assigns the links of nodes with equal ends anew. `crowded` names every such node at least once; nodes
/// not in use are passed over. Returns the number of edges. O(nodes of the graph), and only called when there
/// are any.
template <class Ends>
std::uint64_t pair_crowded_edges(CutGraph<Ends>& graph, std::vector<std::uint32_t> crowded,
                                 Executor& executor) {
    using pairing::Ray;
    using Node = CutNode<Ends>;

    const auto ends_order = [&](std::uint32_t a, std::uint32_t b) {
        return std::memcmp(&graph.nodes[a].ends, &graph.nodes[b].ends, sizeof(Ends));
    };
    std::sort(crowded.begin(), crowded.end(), [&](std::uint32_t a, std::uint32_t b) {
        const int order = ends_order(a, b);
        return order != 0 ? order < 0 : a < b;
    });
    crowded.erase(std::unique(crowded.begin(), crowded.end()), crowded.end());
    executor.check_cancelled();

    const auto third = [&](const Ends& edge, const Ends& other) {
        const bool low_is_shared = other.low == edge.low || other.low == edge.high;
        return low_is_shared ? graph.high(other) : graph.low(other);
    };

    // Arriving triangles are known to the nodes before the edge: one pass over all nodes finds them.
    std::vector<bool> is_crowded(graph.count);
    for (const std::uint32_t id : crowded)
        is_crowded[id] = true;
    struct Arrival {
        std::uint32_t node;
        std::uint32_t from;
        std::uint32_t triangle;
    };
    std::vector<std::vector<Arrival>> found(executor.workers());
    executor.for_chunks(graph.count, 1U << 16, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
        for (std::uint64_t id = begin; id < end; ++id) {
            const Node& node = graph.nodes[id];
            if (!node.in_use() || !node.left())
                continue;
            for (const std::uint32_t next : {node.next_low, node.next_high})
                if (is_crowded[next])
                    found[worker].push_back({next, static_cast<std::uint32_t>(id), node.triangle});
        }
    });
    std::vector<Arrival> arrivals;
    for (std::vector<Arrival>& part : found) {
        arrivals.insert(arrivals.end(), part.begin(), part.end());
        part = std::vector<Arrival>(); // lets go of the memory, too
    }
    const auto by_node = [](const Arrival& a, const Arrival& b) {
        return a.node < b.node;
    };
    executor.check_cancelled();
    std::sort(arrivals.begin(), arrivals.end(), by_node);

    std::uint64_t edges = 0;
    std::vector<Ray> rays;
    std::vector<Node> links;
    for (std::size_t begin = 0; begin < crowded.size();) {
        if (edges % 1024 == 0)
            executor.check_cancelled();
        std::size_t end = begin + 1;
        while (end < crowded.size() && ends_order(crowded[begin], crowded[end]) == 0)
            ++end;

        const Ends edge = graph.nodes[crowded[begin]].ends;
        PlaneSpan span{};
        rays.clear();
        links.clear();
        std::vector<std::uint32_t> spare; // nodes that no contour arrives at, to carry links that stay over
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t id = crowded[i];
            Node& node = graph.nodes[id];
            if (node.in_use())
                span = graph.spans[id];
            if (node.left()) {
                rays.push_back({false, 0, third(edge, graph.nodes[node.next_low].ends), node.triangle,
                                static_cast<std::uint32_t>(links.size())});
                links.push_back(node);
            }
            if (node.entered) {
                const auto arrival =
                    std::lower_bound(arrivals.begin(), arrivals.end(), Arrival{id, 0, 0}, by_node);
                assert(arrival != arrivals.end() && arrival->node == id);
                rays.push_back(
                    {true, 0, third(edge, graph.nodes[arrival->from].ends), arrival->triangle, id});
            } else {
                spare.push_back(id);
            }
            node.next_low = node.next_high = no_node;
        }
        for (Ray& ray : rays)
            ray.angle = pairing::ray_angle(graph.low(edge), graph.high(edge), ray.third);
        std::sort(rays.begin(), rays.end(), pairing::before);

        std::vector<bool> placed(links.size());
        const auto place = [&](std::uint32_t node, std::uint32_t link) {
            assert(!placed[link]);
            const Node& from = links[link];
            Node& to = graph.nodes[node];
            to.next_low = from.next_low;
            to.next_high = from.next_high;
            to.split = from.split;
            to.triangle = from.triangle;
            to.set_last(span.last);
            graph.spans[node] = span;
            placed[link] = true;
        };
        for (const auto& [arriving, leaving] : pairing::match(rays))
            place(rays[arriving].node, rays[leaving].node);
        for (std::uint32_t link = 0; link < links.size(); ++link) {
            if (!placed[link]) {
                assert(!spare.empty()); // a link that no contour arrives at came with a node of that kind
                place(spare.back(), link);
                spare.pop_back();
            }
        }
        for (const std::uint32_t id : spare)
            graph.drop(id);
        edges += rays.size() > 2;
        begin = end;
    }
    return edges;
}

} // namespace lamella
