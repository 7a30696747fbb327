#include "print_check_report.hpp"

#include "numbers.hpp"
#include "options.hpp"
#include "page_notes.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

namespace lamella::app {

namespace {

Json region_json(const PrintRegion& region) {
    return {{"layer", region.layer},
            {"z", {region.bottom_mm, region.top_mm}},
            {"centre", {region.centre.x, region.centre.y}},
            {"area_mm2", region.area_mm2},
            {"largest_mm2", region.largest_mm2},
            {"volume_mm3", region.volume_mm3}};
}

std::string to_micrometres(double mm) {
    return fmt::format("{:.7g}", std::round(mm * 1e3) / 1e3 + 0.0);
}

std::string region_text(const PrintRegion& region) {
    return fmt::format("z = {} to {} mm around ({}, {}): {} mm2, {} mm3", height(region.bottom_mm),
                       height(region.top_mm), to_micrometres(region.centre.x),
                       to_micrometres(region.centre.y), brief(region.area_mm2), brief(region.volume_mm3));
}

/// Returns a line for each of the first few regions.
template <class Region, class Describe>
std::string regions_text(const char* title, const std::vector<Region>& regions, const Describe& describe) {
    constexpr std::size_t few = 10;
    std::string text;
    for (std::size_t i = 0; i < std::min(few, regions.size()); ++i)
        text += fmt::format("    {}{}\n", region_text(regions[i]), describe(regions[i]));
    if (regions.size() > few)
        text += fmt::format("    and {} more; --json lists all\n", grouped(regions.size() - few));
    return text.empty() ? text : fmt::format("  {}\n{}", title, text);
}

std::string end_of(const PrintIsland& island) {
    return fmt::format("{}; {}", island.support ? ", of a support" : "",
                       island.joins ? "then it joins the rest" : "it never joins the rest");
}

std::string end_of(const PrintCavity& cavity) {
    return fmt::format("{}; {}", cavity.on_plate ? ", closed by the plate" : "",
                       cavity.trap()  ? "it stays closed"
                       : cavity.opens ? "then it opens"
                                      : "then material closes it");
}

/// Adds a mark for a region, unless there are enough of its kind.
void add_mark(std::vector<PageLocation>& marks, const char* kind, const PrintRegion& region,
              const std::string& end, std::uint64_t found) {
    const auto of_kind = std::count_if(marks.begin(), marks.end(),
                                       [&](const PageLocation& mark) { return mark.kind == kind; });
    if (static_cast<std::uint64_t>(of_kind) < page_locations)
        marks.push_back({.kind = kind,
                         .text = region_text(region) + end,
                         .points = {{region.centre.x, region.centre.y, region.bottom_mm},
                                    {region.centre.x, region.centre.y, region.top_mm}},
                         .found = found,
                         .of_print = true});
}

/// Returns the layer with the largest value.
const PeelArea* largest(const std::vector<PeelArea>& layers, double PeelArea::*value) {
    const auto found =
        std::max_element(layers.begin(), layers.end(),
                         [&](const PeelArea& a, const PeelArea& b) { return a.*value < b.*value; });
    return found == layers.end() || (*found).*value == 0 ? nullptr : &*found;
}

} // namespace

PrintCheckOptions PrintCheckArguments::options(std::uint64_t max_memory) const {
    PrintCheckOptions options{.max_memory = max_memory};
    options.touch_mm2 = touch_mm2.value_or(options.touch_mm2);
    options.overhang_angle = overhang_angle.value_or(options.overhang_angle);
    check(options);
    return options;
}

std::vector<Option> print_check_options(PrintCheckArguments& target) {
    const PrintCheckOptions defaults;
    Option touch = number("touch", "MM2",
                          "count material as an island, too, if it touches the layer below in no more than "
                          "this area",
                          target.touch_mm2);
    touch.preset = exact(defaults.touch_mm2);
    Option angle = number("overhang-angle", "DEGREES",
                          "smallest angle between a surface and the plate at which each layer is carried by "
                          "the one below",
                          target.overhang_angle);
    angle.preset = exact(defaults.overhang_angle);
    return {std::move(touch), std::move(angle)};
}

Json peel_json(const PeelArea& layer) {
    return {{"index", layer.index},
            {"z", {layer.bottom_mm, layer.top_mm}},
            {"area_mm2", layer.area_mm2},
            {"largest_mm2", layer.largest_mm2},
            {"perimeter_mm", layer.perimeter_mm},
            {"exposed_mm2", layer.exposed_mm2},
            {"overhang_mm2", layer.overhang_mm2},
            {"overhang_mm", layer.overhang_mm}};
}

Json print_check_json(const PrintCheck& check) {
    Json object;
    for (const FindingNumber& number : check.findings.numbers(FindingOrigin::print))
        std::visit([&](auto value) { object[number.key] = value; }, number.value);
    for (const auto& [key, value] : {std::pair{"largest_area", &PeelArea::area_mm2},
                                     {"largest_connected_area", &PeelArea::largest_mm2},
                                     {"largest_exposed_area", &PeelArea::exposed_mm2}}) {
        const PeelArea* const layer = largest(check.layers, value);
        object[key] = layer == nullptr ? Json() : Json{{"z", layer->bottom_mm}, {"area_mm2", layer->*value}};
    }
    Json& islands = object["list_of_islands"] = Json::array();
    for (const PrintIsland& island : check.islands) {
        islands.push_back(region_json(island));
        islands.back()["joins"] = island.joins;
        islands.back()["support"] = island.support;
    }
    Json& cavities = object["list_of_cavities"] = Json::array();
    for (const PrintCavity& cavity : check.cavities) {
        cavities.push_back(region_json(cavity));
        cavities.back()["trap"] = cavity.trap();
        cavities.back()["on_plate"] = cavity.on_plate;
        cavities.back()["opens"] = cavity.opens;
    }
    object["findings"] = check.findings.texts();
    return object;
}

PageSection print_check_section(const PrintCheck& check) {
    PageSection section{"Check of the print", {}};
    for (const FindingDescription& kind : finding_kinds()) {
        if (kind.origin != FindingOrigin::print)
            continue;
        const Finding& found = check.findings.of(kind.kind);
        const Tone tone = found.count == 0                  ? Tone::good
                          : kind.severity == Severity::note ? Tone::plain
                                                            : Tone::warning;
        std::string name = kind.name;
        std::replace(name.begin(), name.end(), '_', ' ');
        name[0] = static_cast<char>(std::toupper(name[0]));
        section.facts.push_back({name, found.count == 0 ? "none" : grouped(found.count), tone});
    }
    return section;
}

std::vector<PageLocation> places_of(const PrintCheck& check) {
    std::vector<PageLocation> marks;
    for (const PrintIsland& island : check.islands)
        add_mark(marks, island.support ? "loose support" : "island", island, end_of(island),
                 check.findings.count(island.support ? FindingKind::loose_supports : FindingKind::islands));
    for (const PrintCavity& cavity : check.cavities)
        add_mark(marks, cavity.trap() ? "trap" : "cup", cavity, end_of(cavity),
                 check.findings.count(cavity.trap() ? FindingKind::traps : FindingKind::cups));
    return marks;
}

std::string print_check_text(const PrintCheck& check) {
    std::string text;
    for (const std::string& finding : check.findings.texts())
        text += fmt::format("  {}\n", finding);
    text += regions_text("islands", check.islands, [](const PrintIsland& island) { return end_of(island); });
    text += regions_text("cups and traps", check.cavities,
                         [](const PrintCavity& cavity) { return end_of(cavity); });
    if (const PeelArea* const layer = largest(check.layers, &PeelArea::area_mm2))
        text += fmt::format("  largest area: {} mm2 at z = {} mm, in one piece at most {} mm2\n",
                            brief(layer->area_mm2), height(layer->bottom_mm), brief(layer->largest_mm2));
    if (check.findings.first(Severity::warning) == nullptr)
        text += "  no islands, no cups, no traps, no empty layers\n";
    return text;
}

} // namespace lamella::app
