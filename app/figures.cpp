#include "figures.hpp"

#include "lamella/contour/stack_hash.hpp"
#include "lamella/core/version.hpp"

#include "config_file.hpp"
#include "failure.hpp"
#include "numbers.hpp"
#include "options.hpp"
#include "print_check_report.hpp"
#include "repair_options.hpp"
#include "resin_figures.hpp"
#include "scan_figures.hpp"
#include "strategy_file.hpp"
#include "system/program_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cctype>
#include <fstream>
#include <numeric>
#include <utility>

namespace lamella::app {
namespace {

Figure count(std::string_view key, std::uint64_t value, std::string_view name) {
    return {key, value, name, grouped(value)};
}

Figure defect(const DefectWords& words, std::uint64_t value, Tone tone) {
    return {words.key, value, words.many, value == 0 ? "none" : grouped(value),
            value == 0 ? Tone::good : tone};
}

Figure time(std::string_view key, double seconds, std::string_view name) {
    return {key, seconds, name, seconds > 0 ? fmt::format("{:.3f} s", seconds) : ""};
}

Figure stage(Stage stage, double seconds) {
    return time(stage_name(stage), seconds, deed(stage));
}

std::string shells_text(const Inspection& found) {
    if (found.cavities == 0)
        return grouped(found.shells);
    return fmt::format("{}, {} of them {}", grouped(found.shells), grouped(found.cavities),
                       found.cavities == 1 ? "a cavity" : "cavities");
}

/// Returns the text with typographic signs, for pages; terminals get plain ASCII.
std::string typeset(std::string text) {
    for (const auto& [plain, sign] : {std::pair{" x ", " × "}, {"mm2", "mm²"}, {"mm3", "mm³"}})
        for (auto at = text.find(plain); at != std::string::npos; at = text.find(plain))
            text.replace(at, 3, sign);
    return text;
}

/// Returns the rows of the 4 by 4 matrix from the file's coordinates to those of the layers.
Json matrix_json(const Transform& map) {
    Json rows = Json::array();
    for (std::size_t r = 0; r < 3; ++r)
        rows.push_back({map.linear[r][0], map.linear[r][1], map.linear[r][2], map.offset[r]});
    rows.push_back({0, 0, 0, 1});
    return rows;
}

Json cases_json(const MatchingCounts::Cases& cases) {
    return {{"new", cases.new_list},
            {"front", cases.front},
            {"back", cases.back},
            {"link", cases.link},
            {"close", cases.close}};
}

Json matching_json(const MatchingCounts& counts) {
    return {{"searches", counts.searches},
            {"comparisons", counts.comparisons},
            {"inserted", cases_json(counts.inserted)},
            {"by_edge_link", cases_json(counts.by_edge_link)},
            {"node_bytes", counts.node_bytes},
            {"bytes", counts.bytes}};
}

Json changes_json(const LayerChanges& changes) {
    return {{"groups_united", changes.groups_united},     {"rings_united", changes.rings_united},
            {"rings_reversed", changes.rings_reversed},   {"rings_dropped", changes.rings_dropped},
            {"rings_vanished", changes.rings_vanished},   {"points_dropped", changes.points_dropped},
            {"area_before_mm2", changes.area_before_mm2}, {"area_after_mm2", changes.area_after_mm2}};
}

/// Adds the numbers that have a key.
void add_numbers(Json& object, std::initializer_list<std::pair<const char*, Json>> numbers) {
    for (const auto& [key, value] : numbers)
        if (*key != '\0')
            object[key] = value;
}

Json layers_json(const FileResult& result) {
    Json layers = Json::array();
    for (const LayerStatistics& layer : result.layers) {
        layers.push_back({{"index", layer.index},
                          {"z", layer.z},
                          {"thickness", layer.thickness},
                          {"contours", layer.measure.contours},
                          {"holes", layer.measure.holes},
                          {"points", layer.measure.points},
                          {"area_mm2", layer.measure.area_mm2},
                          {"perimeter_mm", layer.measure.perimeter_mm},
                          {"open_chains", layer.measure.open_chains},
                          // Written as text, because a JSON number loses digits beyond 2^53.
                          {"hash", fmt::format("{:016x}", layer.hash)}});
        for (const PlaneFinding& found : layer.findings) {
            const FindingDescription& row = description(found.kind);
            add_numbers(layers.back(), {{row.count_key, found.count},
                                        {row.largest_key, found.largest},
                                        {row.layer_amount_key, found.amount}});
        }
        if (!layer.joins.empty())
            layers.back()["gaps"] = joins_json(layer.joins);
        if (result.changes)
            layers.back().update(changes_json(layer.changes));
        if (!layer.scan.empty())
            layers.back()["scan"] = scan_json(result.exposures, layer);
    }
    return layers;
}

Json inputs_json(const FileResult& result) {
    Json inputs = Json::array();
    for (const PlateFile& file : result.files)
        inputs.push_back({{"path", file.path},
                          {"format", file.format},
                          {"triangles", file.stored_triangles},
                          {"unit", unit_name(file.unit_mm)},
                          {"matrix", matrix_json(file.matrix)}});
    return inputs;
}

Json parts_json(const FileResult& result) {
    Json parts = Json::array();
    for (const PartResult& part : result.parts)
        parts.push_back({{"label", part.label},
                         {"triangles", part.triangles},
                         {"bbox", box_json(part.box)},
                         {"contours", part.contours},
                         {"open_chains", part.open_chains},
                         {"inverted_rings", part.inverted_rings},
                         {"points", part.points}});
    return parts;
}

/// Returns the finding with its text, and the path of its file if it belongs to one.
Json finding_json(const FileResult& result, const Finding& found) {
    const FindingDescription& row = description(found.kind);
    Json object = {{"kind", row.name}};
    if (found.file < result.files.size())
        object["path"] = result.files[found.file].path;
    object["count"] = found.count;
    if (*row.unit != '\0')
        object[fmt::format("amount_{}", row.unit)] = found.amount;
    object["layers"] = found.layers;
    object["first_z"] = found.first_z;
    object["text"] = with_options(found.text());
    return object;
}

/// Returns the figures of all files with layers near horizontal faces.
Json near_faces_json(const FileResult& result) {
    Json files = Json::array();
    for (const Finding& found : result.findings.by_file)
        if (found.kind == FindingKind::near_faces)
            files.push_back({{"path", result.files[found.file].path},
                             {"layers", found.layers},
                             {"first_z", found.first_z},
                             {"area_mm2", found.amount},
                             {"farthest_mm", found.largest}});
    return files;
}

/// Appends a value. Objects and lists that contain plain values only, such as a layer, a point or a row of a
/// matrix, take one line each.
void append_json(std::string& text, const Json& value, std::size_t depth) {
    if (std::none_of(value.begin(), value.end(), [](const Json& item) { return item.is_structured(); })) {
        text += compact_json(value);
        return;
    }
    const bool is_object = value.is_object();
    text += is_object ? '{' : '[';
    const char* separator = "\n";
    for (const auto& [key, item] : value.items()) {
        text.append(separator).append(2 * depth + 2, ' ');
        if (is_object)
            text.append(compact_json(key)).append(": ");
        append_json(text, item, depth + 1);
        separator = ",\n";
    }
    text.append(1, '\n').append(2 * depth, ' ');
    text += is_object ? '}' : ']';
}

} // namespace

Figures mesh_figures(const Inspection& found) {
    const bool closed = found.closed();
    const bool sound = found.sound();
    return {
        {"surface",
         {},
         "surface",
         sound    ? "closed, without defects"
         : closed ? "closed, with defects"
                  : "not closed",
         sound    ? Tone::good
         : closed ? Tone::warning
                  : Tone::bad},
        count("triangles", found.triangles, "triangles"),
        count("vertices", found.vertices, "vertices"),
        {"bbox", box_json(found.box), "size", size_text(found.box)},
        {"place", {}, "from", fmt::format("{} to {}", point_text(found.box.min), point_text(found.box.max))},
        {"volume_mm3", closed ? Json(found.volume_mm3) : Json(), "volume",
         closed ? fmt::format("{} mm3", brief(found.volume_mm3)) : "none: the surface is not closed"},
        {"area_mm2", found.area_mm2, "area", fmt::format("{} mm2", brief(found.area_mm2))},
        {"closed", closed, "closed", closed ? "yes" : "no"},
        {"shells", found.shells, "shells", shells_text(found)},
        count("cavities", found.cavities, "cavities")};
}

Figures defect_figures(const Inspection& found) {
    Figures figures;
    for (const DefectKind& kind : defect_kinds)
        figures.push_back(
            defect(kind.words, found.*kind.count, kind.spoils_contours ? Tone::bad : Tone::warning));
    return figures;
}

Figures intersection_figures(const SelfIntersections& found) {
    Figures figures;
    for (const IntersectionWords& kind : intersection_words)
        figures.push_back(defect(kind.words, found.*kind.count, Tone::warning));
    return figures;
}

Figures layer_figures(std::uint64_t layers, const LayerMeasure& all, double volume_mm3) {
    return {count("layers", layers, "layers"),
            count("contours", all.contours, "contours"),
            {"open_chains", all.open_chains, "open chains",
             all.open_chains == 0 ? "none" : grouped(all.open_chains)},
            count("points", all.points, "points"),
            {"volume_mm3", volume_mm3, "volume", fmt::format("{} mm3", brief(volume_mm3))}};
}

std::uint64_t triangles_read(const FileResult& result) {
    return std::accumulate(
        result.files.begin(), result.files.end(), std::uint64_t{0},
        [](std::uint64_t sum, const PlateFile& file) { return sum + file.stored_triangles; });
}

/// Returns the hash of the hashes of all layers, and of their scan vectors.
std::string hash_of_layers(const std::vector<LayerStatistics>& layers) {
    std::vector<std::uint64_t> hashes;
    for (const LayerStatistics& layer : layers) {
        hashes.push_back(layer.hash);
        if (!layer.scan.empty())
            hashes.push_back(layer.scan_hash);
    }
    return fmt::format("{:016x}", stack_hash(hashes));
}

Figures run_figures(const FileResult& result) {
    const SliceReport& report = result.report;
    const FileResult::Seconds& seconds = result.seconds;
    Figures figures{
        count("triangles", triangles_read(result), "triangles"),
        {"parts", {}, "parts", result.parts.size() > 1 ? grouped(result.parts.size()) : ""},
        {"bbox", box_json(result.box), "size", size_text(result.box)},
        {"engine", result.engine, "engine", result.engine},
        count("threads", result.threads, "threads"),
        stage(Stage::read, seconds.read),
        stage(Stage::weld, seconds.weld),
        stage(Stage::link, seconds.link),
        stage(Stage::slice, seconds.slice),
        stage(Stage::polygon, seconds.polygon),
        time("scan", seconds.scan, "scanned"),
        time("format", seconds.format, "formatting"),
        stage(Stage::write, seconds.write),
        time("order", seconds.order, "in order"),
        time("end", seconds.end, "ending"),
        {"total", seconds.total},
        {"hash", hash_of_layers(result.layers)},
        {"bytes", result.bytes, "written",
         result.format.empty() ? "" : fmt::format("{}, {}", result.format, byte_size(result.bytes))}};
    LayerMeasure all;
    all.contours = report.contours;
    all.open_chains = report.open_chains;
    all.points = report.points;
    for (Figure& figure : layer_figures(report.layers, all, result.volume_mm3))
        figures.push_back(std::move(figure));
    return figures;
}

Figures picked(const Figures& figures, const std::vector<std::string_view>& keys) {
    Figures found;
    for (const std::string_view key : keys)
        for (const Figure& figure : figures)
            if (figure.key == key)
                found.push_back(figure);
    assert(found.size() == keys.size());
    return found;
}

Json as_json(const Figures& figures) {
    Json object;
    for (const Figure& figure : figures)
        object[std::string(figure.key)] = figure.value;
    return object;
}

std::string as_lines(const Figures& figures) {
    std::string text;
    for (const Figure& figure : figures)
        if (!figure.text.empty())
            text += result_line(figure.name, figure.text);
    return text;
}

std::vector<PageFact> as_facts(const Figures& figures) {
    std::vector<PageFact> facts;
    for (const Figure& figure : figures)
        if (!figure.text.empty()) {
            facts.push_back({std::string(figure.name), typeset(figure.text), figure.tone});
            facts.back().name[0] = static_cast<char>(std::toupper(figure.name[0]));
        }
    return facts;
}

Json point_json(const Point3& p) {
    return {p.x, p.y, p.z};
}

Json box_json(const Box3& box) {
    return {point_json(box.min), point_json(box.max)};
}

std::string size_text(const Box3& box) {
    return fmt::format("{} x {} x {} mm", brief(box.max.x - box.min.x), brief(box.max.y - box.min.y),
                       brief(box.max.z - box.min.z));
}

std::string point_text(const Point3& p) {
    return fmt::format("({}, {}, {})", brief(p.x), brief(p.y), brief(p.z));
}

Json open_gaps_json(const OpenGaps& gaps) {
    return {
        {"open_gaps", gaps.count}, {"longest_open_gap_mm", gaps.longest_mm}, {"open_gaps_mm", gaps.total_mm}};
}

void add_findings(Json& stats, const FileResult& result) {
    for (const Finding& found : result.findings.total) {
        const FindingDescription& row = description(found.kind);
        add_numbers(
            stats,
            {{row.count_key, found.count}, {row.largest_key, found.largest}, {row.amount_key, found.amount}});
    }
    Json& findings = stats["findings"] = Json::array();
    for (const Finding& found : result.findings.by_file)
        findings.push_back(finding_json(result, found));
}

Json processes_json(const std::vector<ProcessFigures>& figures) {
    Json processes = Json::array();
    for (const ProcessFigures& one : figures)
        processes.push_back({{"triangles_read", one.triangles_read},
                             {"triangles_sliced", one.triangles_sliced},
                             {"bytes_sent", one.bytes_sent},
                             {"planes", one.planes},
                             {"points", one.points},
                             {"seconds",
                              {{"read", one.read_seconds},
                               {"exchange", one.exchange_seconds},
                               {"slice", one.slice_seconds},
                               {"write", one.write_seconds}}}});
    return processes;
}

Json stats_json(const Command& command, const FileJob& job, const FileResult& result) {
    const PlateFile& first = result.files.front();
    Json options = options_in_effect(command);
    options["matrix"] = matrix_json(first.matrix);
    const bool inspected = result.inspection.has_value();
    const Figures run = run_figures(result);
    Json stats = {{"lamella", version()},
                  {"options", std::move(options)},
                  {"input",
                   {{"path", first.path},
                    {"triangles", triangles_read(result)},
                    {"vertices", inspected ? Json(result.inspection->vertices) : Json()},
                    {"bbox", box_json(result.box)},
                    {"unit", unit_name(first.unit_mm)},
                    {"volume_mm3", result.mesh_volume_mm3},
                    {"defects", inspected ? as_json(defect_figures(*result.inspection)) : Json()}}}};
    stats.update(as_json(picked(run, {"engine", "threads"})));
    stats["seconds"] = as_json(picked(run, {"read", "weld", "link", "slice", "polygon", "scan", "format",
                                            "write", "order", "end", "total"}));
    stats["peak_rss_bytes"] = peak_memory();
    stats.update(as_json(picked(run, {"points", "contours", "open_chains", "volume_mm3", "hash"})));
    if (result.resin)
        stats.update(as_json(amount_figures(*result.resin)));
    if (result.ranges != 0)
        stats["ranges"] = result.ranges;
    if (result.changes) {
        Json changes = {{"changed_layers", result.changes->changed_layers}};
        changes.update(changes_json(*result.changes));
        stats["changes"] = std::move(changes);
    }
    if (job.scan)
        stats["scan"] = scan_json(result, *job.scan);
    if (result.report.matching)
        stats["matching"] = matching_json(*result.report.matching);
    if (result.parts.size() > 1) {
        stats["inputs"] = inputs_json(result);
        stats["parts"] = parts_json(result);
    }
    if (!result.repairs.empty()) {
        Json& repairs = stats["repairs"] = Json::array();
        for (const FileResult::MeshRepair& repair : result.repairs) {
            repairs.push_back(repairs_json(repair.repairs));
            repairs.back()["path"] = result.files[repair.file].path;
        }
    }
    add_findings(stats, result);
    if (result.check)
        stats["check"] = print_check_json(*result.check);
    if (Json near = near_faces_json(result); !near.empty())
        stats["near_faces"] = std::move(near);
    if (job.repair.close_gaps_mm)
        stats["gaps"] = gaps_json(result.gaps);
    stats["layers"] = layers_json(result);
    return stats;
}

std::string json_text(const Json& object) {
    std::string text;
    append_json(text, object, 0);
    return text + "\n";
}

} // namespace lamella::app
