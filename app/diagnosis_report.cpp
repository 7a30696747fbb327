#include "diagnosis_report.hpp"

#include "command_line.hpp"
#include "messages.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "stats_json.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::app {
namespace {

using Json = nlohmann::ordered_json;

/// Places of each kind that are listed.
constexpr std::size_t listed = 3;
constexpr std::size_t listed_in_json = 16;

std::string point(const Point3& p) {
    return fmt::format("({}, {}, {})", brief(p.x), brief(p.y), brief(p.z));
}

std::string size(const Box3& box) {
    return fmt::format("{} x {} x {} mm", brief(box.max.x - box.min.x), brief(box.max.y - box.min.y),
                       brief(box.max.z - box.min.z));
}

Point3 middle(const Box3& box) {
    return {box.min.x / 2 + box.max.x / 2, box.min.y / 2 + box.max.y / 2, box.min.z / 2 + box.max.z / 2};
}

std::string shells_text(const Inspection& found) {
    if (found.cavities == 0)
        return grouped(found.shells);
    return fmt::format("{}, {} of them {}", grouped(found.shells), grouped(found.cavities),
                       found.cavities == 1 ? "a cavity" : "cavities");
}

/// "3 of 2 meshes: gear, gear 2, axle".
std::string parts_text(const MeshFile& file, const Plate& plate) {
    constexpr std::size_t most = 8;
    std::string text = fmt::format(
        "{} of {}: ", grouped(plate.parts.size()),
        file.objects.size() == 1 ? "one mesh" : fmt::format("{} meshes", grouped(file.objects.size())));
    for (std::size_t i = 0; i < std::min(most, plate.parts.size()); ++i)
        text.append(i == 0 ? "" : ", ").append(one_line(plate.parts[i].label));
    return plate.parts.size() > most ? text + ", ..." : text;
}

/// One kind of defect: what it is, what it means, and where it is.
struct Defect {
    std::uint64_t count;
    std::string_view one;
    std::string_view many;
    std::string_view meaning;
    std::vector<std::string> places; ///< the first of them
};

template <class Places, class Tell>
std::vector<std::string> tell_each(const Places& places, const Tell& tell) {
    std::vector<std::string> texts;
    for (std::size_t i = 0; i < std::min(listed, places.size()); ++i)
        texts.push_back(tell(places[i]));
    return texts;
}

std::string edge_text(const EdgePlace& edge) {
    return fmt::format("from {} to {}", point(edge[0]), point(edge[1]));
}

std::string loop_text(const BoundaryLoop& loop) {
    return fmt::format("{} of {}, {} mm long, {} around {}", loop.closed ? "a rim" : "a broken rim",
                       counted(loop.edges(), "edge"), brief(loop.length_mm), size(loop.box),
                       point(middle(loop.box)));
}

std::string shell_text(const Shell& shell) {
    return fmt::format("{}, {}, {} around {}", counted(shell.triangles, "triangle"),
                       fmt::format("{} mm3", brief(shell.volume_mm3)), size(shell.box),
                       point(middle(shell.box)));
}

std::vector<Defect> defects_of(const Diagnosis& found) {
    const Inspection& counts = found.counts;
    std::vector<Shell> inverted;
    std::ranges::copy_if(found.shells, std::back_inserter(inverted),
                         [](const Shell& shell) { return shell.kind == ShellKind::inverted; });
    const auto triangle = [](std::uint32_t i) {
        return fmt::format("triangle {}", grouped(i));
    };
    return {{counts.boundary_edges, "boundary edge", "boundary edges",
             "the surface has holes; contours stay open there", tell_each(found.loops, loop_text)},
            {counts.orientation_conflicts, "orientation conflict", "orientation conflicts",
             "neighbouring triangles face opposite ways; contours stay open there",
             tell_each(found.conflicting_edges, edge_text)},
            {counts.nonmanifold_edges, "crowded edge", "crowded edges",
             "more than two triangles share an edge; contours part or touch there",
             tell_each(found.nonmanifold_edges, edge_text)},
            {found.nonmanifold_vertices, "crowded vertex", "crowded vertices",
             "parts of the surface touch in a point; no harm to contours",
             tell_each(found.vertices, [](const Point3& p) { return "at " + point(p); })},
            {counts.duplicate_triangles, "duplicate triangle", "duplicate triangles",
             found.opposite_pairs > 0 ? "the same triangle more than once, also the other way round"
                                      : "the same triangle more than once",
             tell_each(found.duplicate_triangles, triangle)},
            {counts.degenerate_triangles, "degenerate triangle", "degenerate triangles",
             "two equal corners; left out of everything", tell_each(found.degenerate_triangles, triangle)},
            {counts.inverted_shells, "inverted shell", "inverted shells",
             "inside out; contours run the wrong way round there", tell_each(inverted, shell_text)}};
}

std::string meeting_text(const Meeting& meeting) {
    return fmt::format("triangles {} and {} near {}", grouped(meeting.triangle_a),
                       grouped(meeting.triangle_b), point(meeting.at));
}

std::vector<Defect> meetings_of(const SelfIntersections& found) {
    const auto of_kind = [&](MeetingKind kind) {
        std::vector<Meeting> meetings;
        std::ranges::copy_if(found.first, std::back_inserter(meetings),
                             [kind](const Meeting& meeting) { return meeting.kind == kind; });
        return tell_each(meetings, meeting_text);
    };
    return {{found.crossing, "crossing", "crossings", "pairs of triangles that pass through each other",
             of_kind(MeetingKind::crossing)},
            {found.overlapping, "overlap", "overlaps", "pairs of triangles upon one another in one plane",
             of_kind(MeetingKind::overlapping)},
            {found.touching, "touch", "touches", "pairs of triangles that meet beside their edges",
             of_kind(MeetingKind::touching)}};
}

std::string defects_text(std::string_view name, const std::vector<Defect>& defects) {
    std::string text;
    for (const Defect& defect : defects) {
        if (defect.count == 0)
            continue;
        text += result_line(name, fmt::format("{} {}: {}", grouped(defect.count),
                                              defect.count == 1 ? defect.one : defect.many, defect.meaning));
        for (const std::string& place : defect.places)
            text += result_line("", "  " + place);
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

Json point_json(const Point3& p) {
    return {p.x, p.y, p.z};
}

template <class Places, class Tell>
Json list_json(const Places& places, const Tell& tell) {
    Json list = Json::array();
    for (std::size_t i = 0; i < std::min(listed_in_json, places.size()); ++i)
        list.push_back(tell(places[i]));
    return list;
}

Json edge_json(const EdgePlace& edge) {
    return {point_json(edge[0]), point_json(edge[1])};
}

Json places_json(const Diagnosis& found) {
    const auto loop = [](const BoundaryLoop& l) -> Json {
        return {{"edges", l.edges()},
                {"length_mm", l.length_mm},
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

Json meetings_json(const SelfIntersections& found) {
    const auto meeting = [](const Meeting& m) -> Json {
        return {{"triangles", {m.triangle_a, m.triangle_b}},
                {"kind", meeting_name(m.kind)},
                {"at", point_json(m.at)}};
    };
    const auto pair = [](const PartMeetings& p) -> Json {
        return {{"shells", {p.part_a, p.part_b}},
                {"crossing", p.crossing},
                {"overlapping", p.overlapping},
                {"touching", p.touching}};
    };
    return {{"crossing", found.crossing},
            {"overlapping", found.overlapping},
            {"touching", found.touching},
            {"flat_triangles", found.flat_triangles},
            {"first", list_json(found.first, meeting)},
            {"shells", list_json(found.parts, pair)}};
}

} // namespace

std::string mesh_text(const MeshFile& file, const Diagnosis& found, const Plate& plate) {
    const Inspection& counts = found.counts;
    const Box3& box = counts.box;
    std::string text = fmt::format("{}: mesh, {}\n", one_line(file.path), file.format);
    if (file.unit_mm)
        text += result_line("unit", fmt::format("{} mm, as the file says", brief(*file.unit_mm)));
    if (plate.parts.size() > 1)
        text += result_line("parts", parts_text(file, plate));
    text += result_line("triangles", grouped(file.stored_triangles));
    text += result_line("vertices", grouped(counts.vertices));
    text += result_line("size", size(box));
    text += result_line("from", fmt::format("{} to {}", point(box.min), point(box.max)));
    text += result_line("volume", counts.closed() ? fmt::format("{} mm3", brief(counts.volume_mm3))
                                                  : "none: the surface is not closed");
    text += result_line("area", fmt::format("{} mm2", brief(counts.area_mm2)));
    text += result_line("shells", shells_text(counts));
    text += result_line("closed", counts.closed() ? "yes" : "no");
    const std::string defects = defects_text("defects", defects_of(found));
    text += defects.empty() ? result_line("defects", "none") : defects;
    if (found.self_intersections) {
        const std::string meetings = defects_text("meetings", meetings_of(*found.self_intersections));
        text += meetings.empty() ? result_line("meetings", "none: no two triangles cross, overlap or touch")
                                 : meetings;
        std::uint64_t pairs = 0;
        for (const PartMeetings& part : found.self_intersections->parts)
            pairs += part.part_a != part.part_b ? 1 : 0;
        if (pairs > 0)
            text += result_line("", fmt::format("{} of shells are involved", counted(pairs, "pair")));
    }
    return text;
}

Json mesh_json(const MeshFile& file, const Diagnosis& found, const Plate& plate) {
    const Inspection& counts = found.counts;
    Json defects = defects_json(counts);
    defects["boundary_loops"] = found.boundary_loops;
    defects["nonmanifold_vertices"] = found.nonmanifold_vertices;
    defects["opposite_pairs"] = found.opposite_pairs;
    Json json = {
        {"path", file.path},
        {"format", file.format},
        {"unit", unit_name(plate.files.front().unit_mm)},
        {"triangles", file.stored_triangles},
        {"vertices", counts.vertices},
        {"bbox", box_json(counts.box)},
        {"volume_mm3", counts.volume_mm3},
        {"area_mm2", counts.area_mm2},
        {"closed", counts.closed()},
        {"shells", counts.shells},
        {"cavities", counts.cavities},
        {"defects", std::move(defects)},
        {"boundary_length_mm", found.boundary_length_mm},
        {"places", places_json(found)},
        {"shell_list", shells_json(found)},
        {"self_intersections", found.self_intersections ? meetings_json(*found.self_intersections) : Json()}};
    if (plate.parts.size() > 1)
        json["parts"] = parts_json(plate);
    return json;
}

} // namespace lamella::app
