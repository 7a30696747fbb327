#include "diagnosis_report.hpp"

#include "command_line.hpp"
#include "figures.hpp"
#include "messages.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "standard_streams.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::app {
namespace {

/// Number of listed locations of each kind.
constexpr std::size_t listed = 3;

Point3 middle(const Box3& box) {
    return {box.min.x / 2 + box.max.x / 2, box.min.y / 2 + box.max.y / 2, box.min.z / 2 + box.max.z / 2};
}

/// Returns a text such as "3 of 2 meshes: gear, gear 2, axle".
std::string parts_text(const MeshFile& file, const Plate& plate) {
    return fmt::format("{} of {}: {}", grouped(plate.parts.size()),
                       file.objects.size() == 1 ? "one mesh"
                                                : fmt::format("{} meshes", grouped(file.objects.size())),
                       labels_text(plate.parts));
}

/// Returns whether the objects of a file must be listed, because some are not parts.
bool has_roles(const MeshFile& file) {
    return std::any_of(file.bodies.begin(), file.bodies.end(),
                       [](const MeshBody& body) { return body.role != MeshRole::part; });
}

bool subtracts(const MeshFile& file) {
    return std::any_of(file.instances.begin(), file.instances.end(),
                       [](const MeshInstance& instance) { return instance.negative; });
}

/// Returns "subtracted", "left out" or "read".
std::string_view use_of(const MeshFile& file, const MeshBody& body) {
    if (body.left_out)
        return "left out";
    return body.role == MeshRole::negative && subtracts(file) ? "subtracted" : "read";
}

std::string bodies_text(const MeshFile& file) {
    constexpr std::size_t most = 20;
    std::string text;
    std::string_view name = "objects";
    for (const MeshBody& body : file.bodies) {
        if (&body == file.bodies.data() + most) {
            text +=
                result_line(name, fmt::format("and {} more; --json lists all", file.bodies.size() - most));
            break;
        }
        text += result_line(name, fmt::format("{}: {}, {}, {}",
                                              body.name.empty() ? "(without a name)" : one_line(body.name),
                                              row_of(body.role).name, counted(body.triangles, "triangle"),
                                              use_of(file, body)));
        name = "";
    }
    return text;
}

Json bodies_json(const MeshFile& file) {
    Json bodies = Json::array();
    for (const MeshBody& body : file.bodies)
        bodies.push_back({{"name", body.name},
                          {"role", row_of(body.role).word},
                          {"triangles", body.triangles},
                          {"use", use_of(file, body)}});
    return bodies;
}

struct Defect {
    DefectWords words;
    std::uint64_t count;
    std::vector<std::string> locations; ///< the first locations
    std::string addition = {};          ///< appended to their meaning
};

template <class Places, class Describe>
std::vector<std::string> describe_each(const Places& locations, const Describe& describe) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < std::min(listed, locations.size()); ++i)
        texts.push_back(describe(locations[i]));
    return texts;
}

std::string edge_text(const EdgeLocation& edge) {
    return fmt::format("from {} to {}", point_text(edge[0]), point_text(edge[1]));
}

std::string loop_text(const BoundaryLoop& loop) {
    return fmt::format("{} of {}, {} mm long, {} around {}", loop.closed ? "a rim" : "a broken rim",
                       counted(loop.edges(), "edge"), brief(loop.length_mm), size_text(loop.box),
                       point_text(middle(loop.box)));
}

std::string shell_text(const Shell& shell) {
    return fmt::format("{}, {}, {} around {}", counted(shell.triangles, "triangle"),
                       fmt::format("{} mm3", brief(shell.volume_mm3)), size_text(shell.box),
                       point_text(middle(shell.box)));
}

/// Returns "; 2 of 3 rims are no wider than rounding ...".
std::string slits_text(const Diagnosis& found) {
    if (found.slits == 0)
        return {};
    // If a plane intersects a slit at a small angle, the sides are farther apart on the plane.
    constexpr double least = 1e-6;
    const int power = static_cast<int>(std::ceil(std::log10(std::max(least, 10 * found.widest_slit_mm))));
    return fmt::format(
        "; {} of {} no wider than rounding, as where vertices lie on edges of neighbours (T-junctions): "
        "lamella slice --close-gaps 1e{} closes their contours",
        grouped(found.slits),
        found.boundary_loops == 1
            ? "1 rim is"
            : fmt::format("{} rims {}", grouped(found.boundary_loops), found.slits == 1 ? "is" : "are"),
        power);
}

std::vector<Defect> defects_of(const Diagnosis& found) {
    const Inspection& counts = found.counts;
    std::vector<Shell> inverted;
    std::copy_if(found.shells.begin(), found.shells.end(), std::back_inserter(inverted),
                 [](const Shell& shell) { return shell.kind == ShellKind::inverted; });
    const auto triangle = [](std::uint32_t i) {
        return fmt::format("triangle {}", grouped(i));
    };
    const auto defect = [&](std::uint64_t Inspection::*count, std::vector<std::string> locations,
                            std::string addition = "") {
        return Defect{words_of(count), counts.*count, std::move(locations), std::move(addition)};
    };
    return {defect(&Inspection::boundary_edges, describe_each(found.loops, loop_text), slits_text(found)),
            defect(&Inspection::orientation_conflicts, describe_each(found.conflicting_edges, edge_text)),
            defect(&Inspection::nonmanifold_edges, describe_each(found.nonmanifold_edges, edge_text)),
            {non_manifold_vertices, found.nonmanifold_vertices,
             describe_each(found.vertices, [](const Point3& p) { return "at " + point_text(p); })},
            defect(&Inspection::duplicate_triangles, describe_each(found.duplicate_triangles, triangle),
                   found.opposite_pairs > 0 ? ", also the other way round" : ""),
            defect(&Inspection::degenerate_triangles, describe_each(found.degenerate_triangles, triangle)),
            defect(&Inspection::inverted_shells, describe_each(inverted, shell_text))};
}

std::string intersection_text(const TriangleIntersection& intersection) {
    return fmt::format("triangles {} and {} near {}", grouped(intersection.triangle_a),
                       grouped(intersection.triangle_b), point_text(intersection.at));
}

std::vector<Defect> intersections_of(const SelfIntersections& found) {
    std::vector<Defect> defects;
    for (const IntersectionWords& kind : intersection_words) {
        std::vector<TriangleIntersection> intersections;
        for (const TriangleIntersection& intersection : found.first)
            if (words_of(intersection.kind).key == kind.words.key)
                intersections.push_back(intersection);
        defects.push_back({kind.words, found.*kind.count, describe_each(intersections, intersection_text)});
    }
    return defects;
}

std::string defects_text(std::string_view name, const std::vector<Defect>& defects) {
    std::string text;
    for (const Defect& defect : defects) {
        if (defect.count == 0)
            continue;
        const DefectWords& words = defect.words;
        text += result_line(name, fmt::format("{} {}: {}{}", grouped(defect.count),
                                              defect.count == 1 ? words.one : words.many, words.meaning,
                                              defect.addition));
        for (const std::string& location : defect.locations)
            text += result_line("", "  " + location);
        name = "";
    }
    return text;
}

Json parts_json(const Plate& plate) {
    Json parts = Json::array();
    for (const PlatePart& part : plate.parts)
        parts.push_back({{"label", part.label},
                         {"triangles", plate.shapes[part.shape].mesh.size()},
                         {"bbox", box_json(part.box)}});
    return parts;
}

Json edge_json(const EdgeLocation& edge) {
    return {point_json(edge[0]), point_json(edge[1])};
}

Json locations_json(const Diagnosis& found) {
    const auto loop = [](const BoundaryLoop& l) -> Json {
        return {{"edges", l.edges()},
                {"length_mm", l.length_mm},
                {"width_mm", l.width_mm},
                {"closed", l.closed},
                {"start", point_json(l.points.front())},
                {"bbox", box_json(l.box)}};
    };
    const auto number = [](std::uint32_t i) {
        return Json(i);
    };
    return {{"boundary_loops", list_json(found.loops, loop)},
            {"nonmanifold_edges", list_json(found.nonmanifold_edges, edge_json)},
            {"orientation_conflicts", list_json(found.conflicting_edges, edge_json)},
            {"nonmanifold_vertices", list_json(found.vertices, point_json)},
            {"duplicate_triangles", list_json(found.duplicate_triangles, number)},
            {"degenerate_triangles", list_json(found.degenerate_triangles, number)}};
}

Json shells_json(const Diagnosis& found) {
    return list_json(found.shells, [](const Shell& shell) -> Json {
        return {{"kind", shell_kind_name(shell.kind)},
                {"first_triangle", shell.first_triangle},
                {"triangles", shell.triangles},
                {"bbox", box_json(shell.box)},
                {"volume_mm3", shell.volume_mm3},
                {"inside", shell.inside ? Json(*shell.inside) : Json()},
                {"depth", shell.depth}};
    });
}

Json intersections_json(const SelfIntersections& found) {
    const auto intersection = [](const TriangleIntersection& m) -> Json {
        return {{"triangles", {m.triangle_a, m.triangle_b}},
                {"kind", words_of(m.kind).key},
                {"at", point_json(m.at)}};
    };
    const auto pair = [](const PartIntersections& p) -> Json {
        return {{"shells", {p.part_a, p.part_b}},
                {"crossing", p.crossing},
                {"overlapping", p.overlapping},
                {"touching", p.touching}};
    };
    Json json = as_json(intersection_figures(found));
    json["flat_triangles"] = found.flat_triangles;
    json["first"] = list_json(found.first, intersection);
    json["shells"] = list_json(found.parts, pair);
    return json;
}

/// Returns the figures, with the number of triangles as the file stores them. What negative volumes remove
/// is known for each layer only, so the volume and the area are those of the parts.
Figures figures_of(const MeshFile& file, const Diagnosis& found) {
    Inspection counts = found.counts;
    counts.triangles = file.stored_triangles;
    Figures figures = mesh_figures(counts);
    for (Figure& figure : figures)
        if (subtracts(file) && ((figure.key == "volume_mm3" && counts.closed()) || figure.key == "area_mm2"))
            figure.text += " of the parts; negative volumes are not subtracted here, but from layers";
    return figures;
}

} // namespace

std::string mesh_text(const MeshFile& file, const Diagnosis& found, const Plate& plate) {
    std::string text = fmt::format("{}: mesh, {}\n", one_line(input_name(file.path)), file.format);
    if (file.unit_mm)
        text += result_line("unit", fmt::format("{} mm, as the file says", brief(*file.unit_mm)));
    if (plate.parts.size() > 1)
        text += result_line("parts", parts_text(file, plate));
    if (has_roles(file))
        text += bodies_text(file);
    text += as_lines(picked(figures_of(file, found), {"triangles", "vertices", "bbox", "place", "volume_mm3",
                                                      "area_mm2", "shells", "closed"}));
    const std::string defects = defects_text("defects", defects_of(found));
    text += defects.empty() ? result_line("defects", "none") : defects;
    if (found.self_intersections) {
        const std::string intersections =
            defects_text("intersections", intersections_of(*found.self_intersections));
        text += intersections.empty()
                    ? result_line("intersections", "none: no two triangles cross, overlap or touch")
                    : intersections;
        std::uint64_t pairs = 0;
        for (const PartIntersections& part : found.self_intersections->parts)
            pairs += part.part_a != part.part_b ? 1 : 0;
        if (pairs > 0)
            text += result_line("", fmt::format("{} of shells {} involved", counted(pairs, "pair"),
                                                pairs == 1 ? "is" : "are"));
    }
    return text;
}

Json mesh_json(const MeshFile& file, const Diagnosis& found, const Plate& plate) {
    const Figures figures = figures_of(file, found);
    Json defects = as_json(defect_figures(found.counts));
    defects["boundary_loops"] = found.boundary_loops;
    defects["slits"] = found.slits;
    defects["nonmanifold_vertices"] = found.nonmanifold_vertices;
    defects["opposite_pairs"] = found.opposite_pairs;
    Json json = {
        {"path", file.path}, {"format", file.format}, {"unit", unit_name(plate.files.front().unit_mm)}};
    json.update(as_json(picked(figures, {"triangles", "vertices", "bbox", "volume_mm3", "area_mm2", "closed",
                                         "shells", "cavities"})));
    json["defects"] = std::move(defects);
    json["boundary_length_mm"] = found.boundary_length_mm;
    json["places"] = locations_json(found);
    json["shell_list"] = shells_json(found);
    json["self_intersections"] =
        found.self_intersections ? intersections_json(*found.self_intersections) : Json();
    if (plate.parts.size() > 1)
        json["parts"] = parts_json(plate);
    if (!file.bodies.empty())
        json["objects"] = bodies_json(file);
    return json;
}

} // namespace lamella::app
