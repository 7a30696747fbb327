#pragma once

// 3MF and AMF files in memory.

#include "container/zip_bytes.hpp"

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::package_test {

/// Returns a box [0, x] x [0, y] x [0, z] as the content of a 3MF <object>.
inline std::string box_mesh(double x = 1, double y = 2, double z = 3) {
    std::string mesh = "<mesh><vertices>\n";
    for (int i = 0; i < 8; ++i)
        mesh += fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", (i & 1) != 0 ? x : 0,
                            (i & 2) != 0 ? y : 0, (i & 4) != 0 ? z : 0);
    mesh += "</vertices><triangles>\n";
    for (const char* t : {"0 2 1", "1 2 3", "4 5 6", "5 7 6", "0 1 4", "1 5 4", "2 6 3", "3 6 7", "0 4 2",
                          "2 4 6", "1 3 5", "3 7 5"})
        mesh += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", t[0], t[2], t[4]);
    return mesh + "</triangles></mesh>";
}

inline std::string model(std::string_view resources, std::string_view build,
                         std::string_view attributes = "") {
    return fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                       "<model xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
                       "xmlns:p=\"http://schemas.microsoft.com/3dmanufacturing/production/2015/06\" {}>\n"
                       "<resources>{}</resources>\n<build>{}</build>\n</model>\n",
                       attributes, resources, build);
}

inline std::string object(int id, std::string_view content, std::string_view attributes = "") {
    return fmt::format("<object id=\"{}\" {}>{}</object>\n", id, attributes, content);
}

inline std::string components(const std::vector<std::pair<int, std::string>>& uses) {
    std::string text = "<components>";
    for (const auto& [id, attributes] : uses)
        text += fmt::format("<component objectid=\"{}\" {}/>", id, attributes);
    return text + "</components>";
}

inline std::string relationships(const std::vector<std::string>& targets) {
    std::string text =
        "<Relationships xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">";
    for (std::size_t i = 0; i < targets.size(); ++i)
        text += fmt::format("<Relationship Target=\"{}\" Id=\"r{}\" "
                            "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>",
                            targets[i], i);
    return text + "</Relationships>";
}

inline const std::string content_types =
    "<Types xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">"
    "<Default Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>"
    "<Default Extension=\"model\" "
    "ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+xml\"/></Types>";

/// Returns a 3MF package of a root model and further parts.
inline std::string package(std::string_view root,
                           const std::vector<std::pair<std::string, std::string>>& others = {},
                           bool deflate = true) {
    std::vector<zip_test::ZipPart> parts = {
        {.name = "[Content_Types].xml", .content = content_types, .deflated = deflate},
        {.name = "_rels/.rels", .content = relationships({"/3D/3dmodel.model"}), .deflated = deflate},
        {.name = "3D/3dmodel.model", .content = std::string(root), .deflated = deflate}};
    if (!others.empty()) {
        std::vector<std::string> targets;
        for (const auto& [name, content] : others)
            targets.push_back("/" + name);
        parts.push_back(
            {.name = "3D/_rels/3dmodel.model.rels", .content = relationships(targets), .deflated = deflate});
    }
    for (const auto& [name, content] : others)
        parts.push_back({.name = name, .content = content, .deflated = deflate});
    return zip_test::zip_bytes(parts);
}

/// Returns a tetrahedron with legs of length 1, as an AMF <object>.
inline std::string amf_object(std::string_view id, std::string_view more = "") {
    return fmt::format(
        "<object id=\"{}\">{}<mesh><vertices>"
        "<vertex><coordinates><x>0</x><y>0</y><z>0</z></coordinates></vertex>\n"
        "<vertex><coordinates><x>1</x><y>0</y><z>0</z></coordinates></vertex>\n"
        "<vertex><coordinates><x>0</x><y>1</y><z>0</z></coordinates></vertex>\n"
        "<vertex><coordinates><x>0</x><y>0</y><z>1</z></coordinates></vertex></vertices>\n<volume>"
        "<triangle><v1>0</v1><v2>2</v2><v3>1</v3></triangle>\n<triangle><v1>0</v1><v2>1</v2><v3>3</v3></"
        "triangle>\n"
        "<triangle><v1>0</v1><v2>3</v2><v3>2</v3></triangle>\n<triangle><v1>1</v1><v2>2</v2><v3>3</v3></"
        "triangle>"
        "</volume></mesh></object>\n",
        id, more);
}

inline std::string amf(std::string_view content, std::string_view attributes = "") {
    return fmt::format("<?xml version=\"1.0\" encoding=\"utf-8\"?>\n<amf {}>\n{}</amf>\n", attributes,
                       content);
}

} // namespace lamella::package_test
