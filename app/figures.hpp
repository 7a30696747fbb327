#pragma once

// Figures of meshes, layers and runs. Each figure is defined once; JSON, lines for people and pages are made
// from this definition.

#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/file_result.hpp"
#include "lamella/mesh/self_intersections.hpp"

#include "command.hpp"
#include "messages.hpp"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace lamella::app {

struct Figure {
    std::string_view key; ///< in JSON
    Json value;
    std::string_view name = {}; ///< for people
    std::string text = {};      ///< value for people; "" if it is shown in JSON only
    Tone tone = Tone::plain;    ///< on pages
};
using Figures = std::vector<Figure>;

[[nodiscard]] Figures mesh_figures(const Inspection& found);
[[nodiscard]] Figures defect_figures(const Inspection& found);
[[nodiscard]] Figures intersection_figures(const SelfIntersections& found);
[[nodiscard]] Figures layer_figures(std::uint64_t layers, const LayerMeasure& all, double volume_mm3);
/// Returns the number of triangles in all files, usable or not.
[[nodiscard]] std::uint64_t triangles_read(const FileResult& result);
[[nodiscard]] Figures run_figures(const FileResult& result);

/// Returns the figures with these keys, in the order of the keys.
[[nodiscard]] Figures picked(const Figures& figures, const std::vector<std::string_view>& keys);
[[nodiscard]] Json as_json(const Figures& figures);
[[nodiscard]] std::string as_lines(const Figures& figures);
[[nodiscard]] std::vector<PageFact> as_facts(const Figures& figures);

[[nodiscard]] Json point_json(const Point3& p);
/// Returns a JSON list of the results of `describe` for the first few locations.
template <class Places, class Describe>
[[nodiscard]] Json list_json(const Places& places, const Describe& describe) {
    Json list = Json::array();
    for (std::size_t i = 0; i < places.size() && i < 16; ++i)
        list.push_back(describe(places[i]));
    return list;
}
/// Returns [[x, y, z], [x, y, z]].
[[nodiscard]] Json box_json(const Box3& box);
/// Returns "(1, 2, 3)".
[[nodiscard]] std::string point_text(const Point3& p);
/// Returns "20 x 30 x 10 mm".
[[nodiscard]] std::string size_text(const Box3& box);

[[nodiscard]] Json open_gaps_json(const OpenGaps& gaps);
/// Adds the numbers of the findings of all files, and `findings`, which lists them file by file.
void add_findings(Json& stats, const FileResult& result);
/// Returns the output of `lamella slice --stats`; docs/program.md lists the keys.
[[nodiscard]] Json stats_json(const Command& command, const FileJob& job, const FileResult& result);
[[nodiscard]] Json processes_json(const std::vector<ProcessFigures>& figures);
/// Returns the JSON as text with a line end; in names that are not UTF-8, invalid bytes become replacement
/// characters.
[[nodiscard]] std::string json_text(const Json& object);

/// Returns the labels of the first few parts: "rook, rook 2, axle".
template <class Parts>
[[nodiscard]] std::string labels_text(const Parts& parts) {
    std::string text;
    for (std::size_t i = 0; i < parts.size() && i < 8; ++i)
        text.append(i == 0 ? "" : ", ").append(one_line(parts[i].label));
    return parts.size() > 8 ? text + ", ..." : text;
}

} // namespace lamella::app
