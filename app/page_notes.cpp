#include "page_notes.hpp"

#include "numbers.hpp"
#include "options.hpp"
#include "standard_streams.hpp"
#include "viewer_page.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

namespace lamella::app {
namespace {

std::string size_text(const Box3& box) {
    return fmt::format("{} × {} × {} mm", brief(box.max.x - box.min.x), brief(box.max.y - box.min.y),
                       brief(box.max.z - box.min.z));
}

std::string seconds(double value) {
    return fmt::format("{:.3f} s", value);
}

/// A kind of defect: "none" is as it should be.
PageFact defect(std::string name, std::uint64_t count, Tone tone) {
    return {std::move(name), count == 0 ? "none" : grouped(count), count == 0 ? Tone::good : tone};
}

PageSection input_section(const FileResult& result) {
    PageSection section{"Input", {}};
    for (const PlateFile& file : result.files) {
        section.facts.push_back({"File", title_of(file.path)});
        section.facts.push_back(
            {"Format", fmt::format("{}, in {}", file.format, unit_name(file.unit_mm))});
    }
    section.facts.push_back({"Triangles", grouped(result.triangles)});
    if (result.parts.size() > 1)
        section.facts.push_back({"Parts", grouped(result.parts.size())});
    section.facts.push_back({"Size", size_text(result.box)});
    return section;
}

PageSection run_section(const FileResult& result) {
    const FileResult::Seconds& s = result.seconds;
    PageSection section{"The run", {{"Engine", result.engine}, {"Threads", grouped(result.threads)}}};
    const auto stage = [&](const char* name, double time) {
        if (time > 0)
            section.facts.push_back({name, seconds(time)});
    };
    stage("Reading", s.read);
    stage("Welding and inspecting", s.weld);
    stage("Linking", s.link);
    stage("Slicing", s.slice);
    stage("Making", s.polygon);
    stage("Writing in order", s.write);
    if (!result.format.empty())
        section.facts.push_back({"Written", fmt::format("{}, {}", result.format, byte_size(result.bytes))});
    return section;
}

} // namespace

std::string title_of(const std::string& path) {
    return std::filesystem::path(input_name(path)).filename().string();
}

PageOptions page_options(const std::string& path) {
    return {.viewer = viewer_page(), .no_viewer = no_viewer(), .title = title_of(path)};
}

PageSection mesh_section(const Inspection& found) {
    PageSection section{
        "Mesh",
        {{"Surface",
          found.sound()    ? "closed, without defects"
          : found.closed() ? "closed, with defects"
                           : "not closed",
          found.sound()    ? Tone::good
          : found.closed() ? Tone::warning
                           : Tone::bad},
         {"Triangles", grouped(found.triangles)},
         {"Vertices", grouped(found.vertices)},
         {"Size", size_text(found.box)},
         {"Volume", found.closed() ? fmt::format("{} mm³", brief(found.volume_mm3)) : "none: not closed"},
         {"Surface area", fmt::format("{} mm²", brief(found.area_mm2))},
         {"Shells", found.cavities == 0 ? grouped(found.shells)
                                        : fmt::format("{}, of them {} cavities", grouped(found.shells),
                                                      grouped(found.cavities))}}};
    section.facts.push_back(defect("Edges of holes", found.boundary_edges, Tone::bad));
    section.facts.push_back(defect("Edges facing opposite ways", found.orientation_conflicts, Tone::bad));
    section.facts.push_back(defect("Crowded edges", found.nonmanifold_edges, Tone::warning));
    section.facts.push_back(defect("Shells inside out", found.inverted_shells, Tone::bad));
    section.facts.push_back(defect("Duplicate triangles", found.duplicate_triangles, Tone::warning));
    section.facts.push_back(defect("Triangles without area", found.degenerate_triangles, Tone::warning));
    return section;
}

PageNotes run_notes(const FileResult& result) {
    PageNotes notes;
    if (result.inspection)
        notes.sections.push_back(mesh_section(*result.inspection));
    notes.sections.push_back(input_section(result));
    notes.sections.push_back(run_section(result));
    for (const LayerStatistics& layer : result.layers)
        if (layer.changes.changed_layers > 0)
            notes.changes.push_back({layer.index, layer.changes});
    return notes;
}

PageNotes mesh_notes(const MeshFile& file, const Diagnosis& found) {
    PageSection section{"File", {{"Name", title_of(file.path)}, {"Format", file.format}}};
    if (file.unit_mm)
        section.facts.push_back({"Unit", fmt::format("{} mm, as the file says", brief(*file.unit_mm))});
    section.facts.push_back({"Triangles in it", grouped(file.stored_triangles)});
    for (const std::string& warning : file.warnings)
        section.facts.push_back({"Remark", warning, Tone::warning});
    PageSection mesh = mesh_section(found.counts);
    if (found.self_intersections) {
        const SelfIntersections& meetings = *found.self_intersections;
        mesh.facts.push_back(defect("Triangles that cross", meetings.crossing, Tone::warning));
        mesh.facts.push_back(defect("Triangles upon one another", meetings.overlapping, Tone::warning));
    }
    return {.sections = {std::move(mesh), std::move(section)}, .places = places_of(found)};
}

PageNotes file_notes(const LayerFile& file) {
    PageSection section{"File", {{"Name", title_of(file.path)}, {"Format", file.format}}};
    if (file.rounding.step_mm > 0)
        section.facts.push_back(
            {"Its coordinates are rounded to", fmt::format("{} mm", brief(file.rounding.step_mm))});
    for (const std::string& warning : file.warnings)
        section.facts.push_back({"Remark", warning, Tone::warning});
    return {.sections = {section}, .places = {}};
}

} // namespace lamella::app
