#include "lamella/write/layer_page.hpp"

#include <fmt/format.h>

#include <string_view>

namespace lamella {

namespace {

std::string size_text(const Box3& box) {
    return fmt::format("{:.4g} x {:.4g} x {:.4g} mm", box.max.x - box.min.x, box.max.y - box.min.y,
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

std::string_view meeting_text(MeetingKind kind) {
    return kind == MeetingKind::crossing ? "two triangles pass through each other"
                                         : "two triangles lie upon one another";
}

} // namespace

std::vector<PagePlace> places_of(const Diagnosis& diagnosis) {
    std::vector<PagePlace> places;
    for (const BoundaryLoop& loop : diagnosis.loops)
        places.push_back({"boundary loop", loop_text(loop), loop.points, loop.closed});
    for (const EdgePlace& edge : diagnosis.conflicting_edges)
        places.push_back({"orientation conflict",
                          "the triangles at this edge face opposite ways, and contours stay open",
                          {edge.begin(), edge.end()}});
    for (const EdgePlace& edge : diagnosis.nonmanifold_edges)
        places.push_back({"crowded edge",
                          "more than two triangles share this edge; contours part or touch here",
                          {edge.begin(), edge.end()}});
    for (const Point3& vertex : diagnosis.vertices)
        places.push_back({"crowded vertex", "parts of the surface touch in this point", {vertex}});
    for (const Shell& shell : diagnosis.shells)
        if (shell.kind == ShellKind::inverted)
            places.push_back({"inverted shell",
                              fmt::format("{} triangles in {} face inwards; contours run the wrong way round",
                                          shell.triangles, size_text(shell.box)),
                              outline(shell.box)});
    if (diagnosis.self_intersections)
        for (const Meeting& meeting : diagnosis.self_intersections->first)
            if (meeting.kind != MeetingKind::touching)
                places.push_back(
                    {"self-intersection", std::string(meeting_text(meeting.kind)), {meeting.at}});
    return places;
}

} // namespace lamella
