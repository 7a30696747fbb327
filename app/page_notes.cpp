#include "page_notes.hpp"

#include "figures.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "print_check_report.hpp"
#include "resin_figures.hpp"
#include "scan_figures.hpp"
#include "standard_streams.hpp"
#include "viewer/viewer_page.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <utility>
#include <vector>

namespace lamella::app {
namespace {

void add(PageSection& section, std::vector<PageFact> facts) {
    for (PageFact& fact : facts)
        section.facts.push_back(std::move(fact));
}

PageSection input_section(const FileResult& result) {
    PageSection section{"Input", {}};
    for (const PlateFile& file : result.files) {
        section.facts.push_back({"File", title_of(file.path)});
        section.facts.push_back({"Format", fmt::format("{}, in {}", file.format, unit_name(file.unit_mm))});
    }
    add(section, as_facts(picked(run_figures(result), {"triangles", "parts", "bbox"})));
    return section;
}

} // namespace

std::string title_of(const std::string& path) {
    return std::filesystem::path(input_name(path)).filename().string();
}

std::string title_of(const std::vector<PlateInput>& inputs) {
    const std::string first = title_of(inputs.front().path);
    return inputs.size() == 1 ? first : fmt::format("{} and {} more", first, inputs.size() - 1);
}

std::vector<std::string_view> page_extensions() {
    return {".html", ".htm"};
}

PageOptions page_options(const std::string& path) {
    return {.viewer = viewer_page(), .no_viewer = no_viewer(), .title = title_of(path)};
}

PageSection mesh_section(const Inspection& found) {
    const Figures figures = mesh_figures(found);
    PageSection section{"Mesh", as_facts(picked(figures, {"surface", "triangles", "vertices", "bbox",
                                                          "volume_mm3", "area_mm2", "shells"}))};
    add(section, as_facts(defect_figures(found)));
    return section;
}

PageNotes run_notes(const FileResult& result) {
    PageNotes notes;
    if (result.inspection)
        notes.sections.push_back(mesh_section(*result.inspection));
    notes.sections.push_back(input_section(result));
    notes.sections.push_back(
        {"The run", as_facts(picked(run_figures(result),
                                    {"engine", "threads", "read", "weld", "link", "slice", "polygon", "scan",
                                     "format", "write", "order", "end", "bytes"}))});
    if (result.resin)
        notes.sections.push_back({"The print", as_facts(amount_figures(*result.resin))});
    if (!result.exposures.empty())
        notes.sections.push_back({"Scan vectors", as_facts(scan_figures(result.exposures))});
    if (result.check) {
        notes.sections.push_back(print_check_section(*result.check));
        notes.locations = places_of(*result.check);
    }
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
    if (const auto negatives = std::count_if(file.instances.begin(), file.instances.end(),
                                             [](const MeshInstance& instance) { return instance.negative; });
        negatives > 0)
        section.facts.push_back({"Negative volumes", fmt::format("{}, subtracted from layers, but not from "
                                                                 "this mesh, its volume and its area",
                                                                 negatives)});
    for (const std::string& warning : file.warnings)
        section.facts.push_back({"Remark", warning, Tone::warning});
    PageSection mesh = mesh_section(found.counts);
    if (const auto& met = found.self_intersections) {
        // A surface without other defects can still have these: they are counted separately, but listed among
        // the defects below.
        if (found.counts.sound() && met->crossing + met->overlapping > 0)
            mesh.facts.front() = {"Surface", "closed, but triangles cross or overlap", Tone::warning};
        add(mesh, as_facts(picked(intersection_figures(*met), {"crossing", "overlapping"})));
    }
    return {.sections = {std::move(mesh), std::move(section)}, .locations = places_of(found)};
}

PageNotes file_notes(const LayerFile& file) {
    PageSection section{"File", {{"Name", title_of(file.path)}, {"Format", file.format}}};
    if (file.rounding.step_mm > 0)
        section.facts.push_back(
            {"Its coordinates are rounded to", fmt::format("{} mm", brief(file.rounding.step_mm))});
    for (const std::string& warning : file.warnings)
        section.facts.push_back({"Remark", warning, Tone::warning});
    return {.sections = {section}, .locations = {}};
}

} // namespace lamella::app
