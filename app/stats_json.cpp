#include "stats_json.hpp"

#include "lamella/core/version.hpp"

#include "config_file.hpp"
#include "options.hpp"
#include "repair_options.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>

namespace lamella::app {
namespace {

using Json = nlohmann::ordered_json;

/// Of this program: what getrusage tells includes the process that started it.
std::uint64_t peak_rss_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        constexpr std::string_view key = "VmHWM:";
        if (line.starts_with(key))
            return std::stoull(line.substr(key.size())) * 1024;
    }
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

/// Rows of the 4 by 4 matrix from the file's coordinates to the layers'.
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
                          // As text: a JSON number loses digits beyond 2^53.
                          {"hash", fmt::format("{:016x}", layer.hash)}});
        if (layer.open_gaps.count > 0)
            layers.back().update(open_gaps_json(layer.open_gaps));
        if (!layer.joins.empty())
            layers.back()["gaps"] = joins_json(layer.joins);
        if (result.changes)
            layers.back().update(changes_json(layer.changes));
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
                         {"points", part.points}});
    return parts;
}

/// Objects and lists of plain values take one line each: a layer, a point, a row of a matrix.
void append_json(std::string& text, const Json& value, std::size_t depth) {
    if (std::ranges::none_of(value, [](const Json& item) { return item.is_structured(); })) {
        text += value.dump(-1, ' ', false, Json::error_handler_t::replace);
        return;
    }
    const bool is_object = value.is_object();
    text += is_object ? '{' : '[';
    const char* separator = "\n";
    for (const auto& [key, item] : value.items()) {
        text.append(separator).append(2 * depth + 2, ' ');
        if (is_object)
            text.append(Json(key).dump()).append(": ");
        append_json(text, item, depth + 1);
        separator = ",\n";
    }
    text.append(1, '\n').append(2 * depth, ' ');
    text += is_object ? '}' : ']';
}

} // namespace

Json defects_json(const Inspection& found) {
    return {{"boundary_edges", found.boundary_edges},
            {"nonmanifold_edges", found.nonmanifold_edges},
            {"orientation_conflicts", found.orientation_conflicts},
            {"duplicate_triangles", found.duplicate_triangles},
            {"degenerate_triangles", found.degenerate_triangles},
            {"inverted_shells", found.inverted_shells}};
}

Json open_gaps_json(const OpenGaps& gaps) {
    return {
        {"open_gaps", gaps.count}, {"longest_open_gap_mm", gaps.longest_mm}, {"open_gaps_mm", gaps.total_mm}};
}

Json box_json(const Box3& box) {
    return {{box.min.x, box.min.y, box.min.z}, {box.max.x, box.max.y, box.max.z}};
}

Json stats_json(const Command& command, const FileResult& result) {
    const PlateFile& first = result.files.front();
    Json options = options_in_effect(command);
    options["matrix"] = matrix_json(first.matrix);
    const bool inspected = result.inspection.has_value();
    const FileResult::Seconds& seconds = result.seconds;
    Json stats = {{"lamella", version()},
                  {"options", std::move(options)},
                  {"input",
                   {{"path", first.path},
                    {"triangles", result.files.size() == 1 ? first.stored_triangles : result.triangles},
                    {"vertices", inspected ? Json(result.inspection->vertices) : Json()},
                    {"bbox", box_json(result.box)},
                    {"unit", unit_name(first.unit_mm)},
                    {"volume_mm3", result.mesh_volume_mm3},
                    {"defects", inspected ? defects_json(*result.inspection) : Json()}}},
                  {"engine", result.engine},
                  {"threads", result.threads},
                  {"seconds",
                   {{"read", seconds.read},
                    {"weld", seconds.weld},
                    {"link", seconds.link},
                    {"slice", seconds.slice},
                    {"polygon", seconds.polygon},
                    {"write", seconds.write},
                    {"total", seconds.total}}},
                  {"peak_rss_bytes", peak_rss_bytes()},
                  {"points", result.report.points},
                  {"contours", result.report.contours},
                  {"open_chains", result.report.open_chains},
                  {"volume_mm3", result.volume_mm3}};
    if (result.slabs != 0)
        stats["slabs"] = result.slabs;
    if (result.changes) {
        Json changes = {{"changed_layers", result.changes->changed_layers}};
        changes.update(changes_json(*result.changes));
        stats["changes"] = std::move(changes);
    }
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
    if (result.open_gaps.count > 0)
        stats.update(open_gaps_json(result.open_gaps));
    if (result.gaps.closed > 0)
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
