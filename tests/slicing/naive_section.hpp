#pragma once

// The section of a mesh, triangle by triangle and plane by plane: too slow for use, too simple to be wrong.

#include "lamella/contour/layer.hpp"
#include "lamella/mesh/triangle_soup.hpp"
#include "lamella/slicing/plan.hpp"

#include "slicing/edge_cut.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace lamella::test {

inline bool is_above(double z, double plane, PlaneRule rule) {
    return rule == PlaneRule::section_above ? z > plane : z >= plane;
}

/// The cut of a triangle: from its edge that runs downwards to its edge that runs upwards.
struct CutSegment {
    std::pair<Point3, Point3> from_edge; ///< lower end, upper end
    std::pair<Point3, Point3> to_edge;
    Point2 from;
    Point2 to;
};

inline std::vector<CutSegment> naive_section(std::span<const Triangle3f> triangles, double plane,
                                             PlaneRule rule) {
    std::vector<CutSegment> out;
    for (const Triangle3f& t : triangles) {
        if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
            continue;
        CutSegment segment;
        bool is_cut = false;
        for (std::size_t k = 0; k < 3; ++k) {
            const Point3 a{t[k].x, t[k].y, t[k].z};
            const Point3f& next = t[(k + 1) % 3];
            const Point3 b{next.x, next.y, next.z};
            const bool a_above = is_above(a.z, plane, rule);
            if (a_above == is_above(b.z, plane, rule))
                continue;
            is_cut = true;
            const std::pair<Point3, Point3> edge = a_above ? std::pair(b, a) : std::pair(a, b);
            const EdgeCut cut = rule == PlaneRule::section_above ? EdgeCut(edge.first, edge.second)
                                                                 : EdgeCut(edge.second, edge.first);
            (a_above ? segment.from_edge : segment.to_edge) = edge;
            (a_above ? segment.from : segment.to) = cut.at(plane);
        }
        if (is_cut)
            out.push_back(segment);
    }
    return out;
}

/// Number of times that a segment is traversed from its smaller to its larger end, minus the number of times
/// in reverse. It does not depend on repeated points and on contours that run to and fro on a line.
using NetFlow = std::map<std::pair<Point2, Point2>, int>;

inline void add_flow(NetFlow& flow, const Point2& from, const Point2& to) {
    if (from == to)
        return;
    const bool forward = from < to;
    int& times = flow[forward ? std::pair(from, to) : std::pair(to, from)];
    times += forward ? 1 : -1;
    if (times == 0)
        flow.erase(forward ? std::pair(from, to) : std::pair(to, from));
}

inline NetFlow net_flow(const std::vector<CutSegment>& section) {
    NetFlow flow;
    for (const CutSegment& segment : section)
        add_flow(flow, segment.from, segment.to);
    return flow;
}

inline NetFlow net_flow(const Layer& layer) {
    NetFlow flow;
    for (std::size_t i = 0; i < layer.contours(); ++i) {
        const std::span<const Point2> contour = layer.contour(i);
        for (std::size_t k = 0; k + 1 < contour.size(); ++k)
            add_flow(flow, contour[k], contour[k + 1]);
        if (layer.closed(i))
            add_flow(flow, contour.back(), contour.front());
    }
    return flow;
}

/// Returns the number of chains of a section: the sum over all cut edges of the excess of triangles that lead
/// away from the edge over those that lead to it.
inline std::size_t open_ends(const std::vector<CutSegment>& section) {
    std::map<std::pair<Point3, Point3>, std::array<std::size_t, 2>> uses;
    for (const CutSegment& segment : section) {
        ++uses[segment.from_edge][0];
        ++uses[segment.to_edge][1];
    }
    std::size_t open = 0;
    for (const auto& [edge, count] : uses)
        open += count[0] > count[1] ? count[0] - count[1] : 0;
    return open;
}

} // namespace lamella::test
