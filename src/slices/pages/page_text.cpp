#include "slices/pages/page_text.hpp"

#include "lamella/core/error.hpp"

#include "container/base64.hpp"
#include "container/decimal.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace lamella {

namespace {

constexpr std::string_view position_of_data = "<!--lamella-data-->";

/// Names in the order of Tone.
constexpr std::array<std::string_view, 4> tone_names{"plain", "good", "warning", "bad"};

std::string point_json(const Point3& p) {
    return fmt::format("[{},{},{}]", page_number(p.x), page_number(p.y), page_number(p.z));
}

std::string fact_json(const PageFact& fact) {
    return fmt::format(R"({{"name":{},"value":{},"tone":"{}"}})", page_quoted(fact.name),
                       page_quoted(fact.value), tone_names.at(static_cast<std::size_t>(fact.tone)));
}

std::string section_json(const PageSection& section) {
    return fmt::format(R"({{"title":{},"facts":{}}})", page_quoted(section.title),
                       json_list(section.facts, fact_json));
}

std::string location_json(const PageLocation& position) {
    return fmt::format(R"({{"kind":{},"text":{},"closed":{},"found":{},"of_print":{},"points":{}}})",
                       page_quoted(position.kind), page_quoted(position.text), position.closed,
                       position.found, position.of_print, json_list(position.points, point_json));
}

} // namespace

PageFrame page_frame(const PageOptions& options) {
    const std::string_view viewer = options.viewer;
    if (viewer.empty())
        throw Error(ErrorKind::usage,
                    fmt::format("there is no viewer, and pages need it: {}", options.no_viewer));
    const std::size_t position = viewer.find(position_of_data);
    if (position == std::string_view::npos)
        throw Error(ErrorKind::internal, fmt::format("the viewer has no {}", position_of_data));
    return {viewer.substr(0, position), viewer.substr(position + position_of_data.size())};
}

std::string page_number(double value) {
    return std::isfinite(value) ? shortest_text(value) : "null";
}

std::string page_box(const Box3& box) {
    return box.empty() ? "null" : fmt::format("[{},{}]", point_json(box.min), point_json(box.max));
}

std::string exposure_json(const Exposure& exposure) {
    const ParameterSet& set = exposure.parameters;
    return fmt::format(
        R"({{"part":{},"region":"{}","kind":"{}","contour":{},"parameters":{{"name":{},"power_w":{},)"
        R"("speed_mm_s":{},"jump_speed_mm_s":{},"focus_mm":{},"spot_mm":{},"mark_delay_us":{},"jump_delay_us":{}}}}})",
        page_quoted(exposure.part), scan_region_name(exposure.region), vector_kind_name(exposure.kind),
        exposure.contour, page_quoted(set.name), page_number(set.power_w), page_number(set.speed_mm_s),
        page_number(set.jump_speed_mm_s), page_number(set.focus_mm), page_number(set.spot_mm),
        page_number(set.mark_delay_us), page_number(set.jump_delay_us));
}

std::string notes_json(const PageNotes& notes) {
    return fmt::format(R"({{"sections":{},"places":{}}})", json_list(notes.sections, section_json),
                       json_list(notes.locations, location_json));
}

std::string json_element(std::string_view id, std::string_view json) {
    return fmt::format("<script type=\"application/json\" id=\"{}\">{}</script>\n", id, json);
}

std::string data_element(std::string_view bytes) {
    std::string text = "<script type=\"text/plain\" class=\"data\">";
    append_base64(bytes, text);
    return text + "</script>\n";
}

} // namespace lamella
