#include "lamella/slices/layer_page.hpp"

#include "core/counted.hpp"

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
    return fmt::format("{} of {}, {:.4g} mm long: {}", loop.closed ? "rim" : "broken rim",
                       counted(loop.edges(), "edge"), loop.length_mm,
                       words_of(&Inspection::boundary_edges).meaning);
}

/// Returns a single line through all edges of the box.
std::vector<Point3> outline(const Box3& box) {
    const auto [x0, y0, z0] = box.min;
    const auto [x1, y1, z1] = box.max;
    return {{x0, y0, z0}, {x1, y0, z0}, {x1, y1, z0}, {x0, y1, z0}, {x0, y0, z0}, {x0, y0, z1},
            {x1, y0, z1}, {x1, y0, z0}, {x1, y0, z1}, {x1, y1, z1}, {x1, y1, z0}, {x1, y1, z1},
            {x0, y1, z1}, {x0, y1, z0}, {x0, y1, z1}, {x0, y0, z1}};
}

} // namespace

std::vector<PageLocation> places_of(const Diagnosis& diagnosis) {
    const Inspection& counts = diagnosis.counts;
    std::vector<PageLocation> places;
    const auto edges = [&](std::uint64_t Inspection::*count, const std::vector<EdgeLocation>& of) {
        const DefectWords& words = words_of(count);
        for (const EdgeLocation& edge : of)
            places.push_back({.kind = std::string(words.one),
                              .text = std::string(words.meaning),
                              .points = {edge.begin(), edge.end()},
                              .found = counts.*count});
    };
    for (const BoundaryLoop& loop : diagnosis.loops)
        places.push_back(
            {"boundary loop", loop_text(loop), loop.points, loop.closed, diagnosis.boundary_loops});
    edges(&Inspection::orientation_conflicts, diagnosis.conflicting_edges);
    edges(&Inspection::nonmanifold_edges, diagnosis.nonmanifold_edges);
    for (const Point3& vertex : diagnosis.vertices)
        places.push_back({.kind = std::string(non_manifold_vertices.one),
                          .text = std::string(non_manifold_vertices.meaning),
                          .points = {vertex},
                          .found = diagnosis.nonmanifold_vertices});
    const DefectWords& inverted = words_of(&Inspection::inverted_shells);
    for (const Shell& shell : diagnosis.shells)
        if (shell.kind == ShellKind::inverted)
            places.push_back({.kind = std::string(inverted.one),
                              .text = fmt::format("{} in {}: {}", counted(shell.triangles, "triangle"),
                                                  size_text(shell.box), inverted.meaning),
                              .points = outline(shell.box),
                              .found = counts.inverted_shells});
    if (const auto& met = diagnosis.self_intersections)
        for (const TriangleIntersection& intersection : met->first)
            if (intersection.kind != IntersectionKind::touching)
                places.push_back({.kind = "self-intersection",
                                  .text = std::string(words_of(intersection.kind).meaning),
                                  .points = {intersection.at},
                                  .found = met->crossing + met->overlapping});
    return places;
}

} // namespace lamella
