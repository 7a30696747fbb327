#include "lamella/write/layer_page.hpp"

#include <fmt/format.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

namespace {

std::string size_text(const Box3& box) {
    return fmt::format("{:.4g} × {:.4g} × {:.4g} mm", box.max.x - box.min.x, box.max.y - box.min.y,
                       box.max.z - box.min.z);
}

std::string loop_text(const BoundaryLoop& loop) {
    return fmt::format("{} of {} edges, {:.4g} mm long: {}", loop.closed ? "rim" : "broken rim", loop.edges(),
                       loop.length_mm, words_of(&Inspection::boundary_edges).meaning);
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
std::string kind_text(std::string_view name, std::size_t listed, std::uint64_t total) {
    return listed < total ? fmt::format("{}, the first of {}", name, total) : std::string(name);
}

} // namespace

std::vector<PagePlace> places_of(const Diagnosis& diagnosis) {
    const Inspection& counts = diagnosis.counts;
    std::vector<PagePlace> places;
    const auto edges = [&](std::uint64_t Inspection::*count, const std::vector<EdgePlace>& of) {
        const DefectWords& words = words_of(count);
        for (const EdgePlace& edge : of)
            places.push_back({kind_text(words.one, of.size(), counts.*count),
                              std::string(words.meaning),
                              {edge.begin(), edge.end()}});
    };
    for (const BoundaryLoop& loop : diagnosis.loops)
        places.push_back({kind_text("boundary loop", diagnosis.loops.size(), diagnosis.boundary_loops),
                          loop_text(loop), loop.points, loop.closed});
    edges(&Inspection::orientation_conflicts, diagnosis.conflicting_edges);
    edges(&Inspection::nonmanifold_edges, diagnosis.nonmanifold_edges);
    for (const Point3& vertex : diagnosis.vertices)
        places.push_back(
            {kind_text(crowded_vertices.one, diagnosis.vertices.size(), diagnosis.nonmanifold_vertices),
             std::string(crowded_vertices.meaning),
             {vertex}});
    const DefectWords& inverted = words_of(&Inspection::inverted_shells);
    for (const Shell& shell : diagnosis.shells)
        if (shell.kind == ShellKind::inverted)
            places.push_back({std::string(inverted.one),
                              fmt::format("{} triangles in {}: {}", shell.triangles, size_text(shell.box),
                                          inverted.meaning),
                              outline(shell.box)});
    if (diagnosis.self_intersections)
        for (const Meeting& meeting : diagnosis.self_intersections->first)
            if (meeting.kind != MeetingKind::touching)
                places.push_back(
                    {"self-intersection", std::string(words_of(meeting.kind).meaning), {meeting.at}});
    return places;
}

} // namespace lamella
