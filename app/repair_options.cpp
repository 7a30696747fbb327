#include "repair_options.hpp"

#include "figures.hpp"
#include "numbers.hpp"
#include "options.hpp"

#include <fmt/format.h>

#include <vector>

namespace lamella::app {

OptionGroup repair_options(RepairPolicies& target) {
    return {
        "repair",
        "Repair of the mesh",
        {length("weld-tolerance", "join vertices that are at most this far apart, the closest pairs first",
                target.weld_tolerance_mm),
         flag("drop-duplicates",
              "keep one of several triangles with the same corners; pairs of opposite orientation cancel",
              target.drop_duplicates),
         flag("orient",
              "flip triangles so that neighbours agree, then make bodies face outward and cavities inward",
              target.orient),
         length("close-gaps",
                "join ends of open contours that are at most this far apart, the closest pairs first",
                target.close_gaps_mm)}};
}

std::string repairs_text(const MeshRepairs& repairs) {
    std::string text;
    if (const auto& welded = repairs.welded)
        text += fmt::format("welded   {} joined, moved by up to {} mm; {} dropped; {} left apart\n",
                            fmt::format("{} {}", grouped(welded->joined_vertices),
                                        welded->joined_vertices == 1 ? "vertex" : "vertices"),
                            brief(welded->longest_move_mm), counted(welded->collapsed_triangles, "triangle"),
                            counted(welded->pairs_apart, "pair"));
    if (const auto& dropped = repairs.dropped)
        text += fmt::format("dropped  {} repeated and {} opposite\n",
                            counted(dropped->repeated_triangles, "triangle"),
                            grouped(dropped->opposite_triangles));
    if (const auto& oriented = repairs.oriented)
        text += fmt::format(
            "oriented {} flipped; {} of {} outward, {} inward as voids\n",
            counted(oriented->flipped_triangles, "triangle"), grouped(oriented->flipped_outward),
            fmt::format("{} {}", grouped(oriented->patches), oriented->patches == 1 ? "patch" : "patches"),
            grouped(oriented->flipped_inward));
    return text;
}

std::string gaps_text(const FileResult::Gaps& gaps) {
    if (gaps.closed == 0)
        return "gaps     none closed\n";
    return fmt::format("gaps     {} closed in {}, the lowest at z = {} mm; the longest {} mm, {} mm in all\n",
                       grouped(gaps.closed), counted(gaps.layers, "layer"), brief(gaps.first_z),
                       brief(gaps.longest_mm), brief(gaps.total_mm));
}

Json gaps_json(const FileResult::Gaps& gaps) {
    return {{"closed", gaps.closed},
            {"layers", gaps.layers},
            {"longest_mm", gaps.longest_mm},
            {"total_mm", gaps.total_mm}};
}

Json joins_json(const std::vector<GapJoin>& joins) {
    Json list = Json::array();
    for (const GapJoin& join : joins)
        list.push_back({{"from", {join.from.x, join.from.y}},
                        {"to", {join.to.x, join.to.y}},
                        {"length_mm", join.length_mm}});
    return list;
}

Json repairs_json(const MeshRepairs& repairs) {
    Json json = {{"weld_tolerance", nullptr}, {"drop_duplicates", nullptr}, {"orient", nullptr}};
    if (const auto& welded = repairs.welded)
        json["weld_tolerance"] = {{"joined_vertices", welded->joined_vertices},
                                  {"collapsed_triangles", welded->collapsed_triangles},
                                  {"pairs_apart", welded->pairs_apart},
                                  {"longest_move_mm", welded->longest_move_mm},
                                  {"places", list_json(welded->locations, point_json)}};
    if (const auto& dropped = repairs.dropped)
        json["drop_duplicates"] = {{"repeated_triangles", dropped->repeated_triangles},
                                   {"opposite_triangles", dropped->opposite_triangles},
                                   {"places", list_json(dropped->locations, point_json)}};
    if (const auto& oriented = repairs.oriented)
        json["orient"] = {{"flipped_triangles", oriented->flipped_triangles},
                          {"patches", oriented->patches},
                          {"flipped_outward", oriented->flipped_outward},
                          {"flipped_inward", oriented->flipped_inward},
                          {"non_orientable_patches", oriented->non_orientable_patches},
                          {"places", list_json(oriented->locations, point_json)}};
    return json;
}

} // namespace lamella::app
