#include "lamella/write/layer_page.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace lamella {

namespace {

std::string size_text(const Box3& box) {
    return fmt::format("{:.4g} × {:.4g} × {:.4g} mm", box.max.x - box.min.x, box.max.y - box.min.y,
                       box.max.z - box.min.z);
}

std::string loop_text(const BoundaryLoop& loop) {
    return fmt::format("{} of {} edges, {:.4g} mm long: the surface has a hole here, and contours stay open",
                       loop.closed ? "rim" : "broken rim", loop.edges(), loop.length_mm);
}

/// Its edges as one line: bottom, top, and back along the uprights.
std::vector<Point3> outline(const Box3& box) {
    const auto [x0, y0, z0] = box.min;
    const auto [x1, y1, z1] = box.max;
    return {{x0, y0, z0}, {x1, y0, z0}, {x1, y1, z0}, {x0, y1, z0}, {x0, y0, z0}, {x0, y0, z1},
            {x1, y0, z1}, {x1, y0, z0}, {x1, y0, z1}, {x1, y1, z1}, {x1, y1, z0}, {x1, y1, z1},
            {x0, y1, z1}, {x0, y1, z0}, {x0, y1, z1}, {x0, y0, z1}};
}

/// A kind of which the diagnosis lists only some says so.
std::string kind_text(const char* name, std::size_t listed, std::uint64_t total) {
    return listed < total ? fmt::format("{}, the first of {}", name, total) : name;
}

const char* meeting_text(MeetingKind kind) {
    return kind == MeetingKind::crossing ? "two triangles pass through each other"
                                         : "two triangles lie upon one another";
}

} // namespace

std::vector<PagePlace> places_of(const Diagnosis& diagnosis) {
    const Inspection& counts = diagnosis.counts;
    std::vector<PagePlace> places;
    const auto edges = [&](const char* name, const char* text, const std::vector<EdgePlace>& of,
                           std::uint64_t total) {
        for (const EdgePlace& edge : of)
            places.push_back({kind_text(name, of.size(), total), text, {edge.begin(), edge.end()}});
    };
    for (const BoundaryLoop& loop : diagnosis.loops)
        places.push_back({kind_text("boundary loop", diagnosis.loops.size(), diagnosis.boundary_loops),
                          loop_text(loop), loop.points, loop.closed});
    edges("orientation conflict", "the triangles at this edge face opposite ways, and contours stay open",
          diagnosis.conflicting_edges, counts.orientation_conflicts);
    edges("crowded edge", "more than two triangles share this edge; contours part or touch here",
          diagnosis.nonmanifold_edges, counts.nonmanifold_edges);
    for (const Point3& vertex : diagnosis.vertices)
        places.push_back(
            {kind_text("crowded vertex", diagnosis.vertices.size(), diagnosis.nonmanifold_vertices),
             "parts of the surface touch in this point",
             {vertex}});
    for (const Shell& shell : diagnosis.shells)
        if (shell.kind == ShellKind::inverted)
            places.push_back({"inverted shell",
                              fmt::format("{} triangles in {} face inwards; contours run the wrong way round",
                                          shell.triangles, size_text(shell.box)),
                              outline(shell.box)});
    if (diagnosis.self_intersections)
        for (const Meeting& meeting : diagnosis.self_intersections->first)
            if (meeting.kind != MeetingKind::touching)
                places.push_back({"self-intersection", meeting_text(meeting.kind), {meeting.at}});
    return places;
}

} // namespace lamella
