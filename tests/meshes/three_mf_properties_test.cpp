#include "container/xml.hpp"
#include "meshes/three_mf_properties.hpp"
#include "meshes/three_mf_terms.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lamella::three_mf_properties_cases {
namespace {

/// Returns the violations in these resources; an id is that of the attribute `id`.
std::vector<std::string> violations(const std::string& resources) {
    ThreeMfProperties properties;
    std::vector<std::string> found;
    XmlHandlers handlers;
    handlers.start = [&](XmlName name, const XmlAttributes& attributes, std::size_t) {
        std::optional<std::uint32_t> id;
        if (const std::string_view text = attributes.find("id"); !text.empty())
            id = static_cast<std::uint32_t>(std::stoul(std::string(text)));
        if (const auto violation = properties.check(name, attributes, id))
            found.push_back(*violation);
    };
    handlers.end = [](XmlName) {
    };
    parse_xml(fmt::format("<resources xmlns=\"{}\" xmlns:m=\"{}\">{}</resources>", three_mf::core,
                          three_mf::materials, resources),
              "x", handlers, {.namespaces = true});
    return found;
}

const std::string base = "<basematerials id=\"1\"><base name=\"a\"/></basematerials>";
const std::string colours = "<m:colorgroup id=\"2\"><m:color color=\"#FF0000\"/></m:colorgroup>";
const std::string texture = "<m:texture2d id=\"3\" path=\"/a.png\" "
                            "contenttype=\"image/png\"/><m:texture2dgroup id=\"4\" texid=\"3\"/>";
const std::string composite = "<m:compositematerials id=\"5\" matid=\"1\" matindices=\"0\"/>";

TEST(ThreeMfProperties, FollowTheRulesOfTheirExtension) {
    EXPECT_TRUE(
        violations(base + colours + texture + composite +
                   "<m:multiproperties id=\"6\" pids=\"1 2 4\"/><m:multiproperties id=\"7\" pids=\" 5 \"/>")
            .empty());
}

TEST(ThreeMfProperties, AreNotCheckedInOtherNamespaces) {
    EXPECT_TRUE(violations("<color/><texture2d/><multiproperties/>").empty());
}

TEST(ThreeMfProperties, ReportEachViolation) {
    const auto expect = [](const std::string& resources, const std::string& part) {
        const std::vector<std::string> found = violations(resources);
        ASSERT_EQ(found.size(), 1U) << resources;
        EXPECT_NE(found[0].find(part), std::string::npos) << found[0];
        EXPECT_TRUE(found[0].starts_with("found ")) << found[0];
    };
    expect("<m:color/>", "colour without");
    expect("<m:texture2d id=\"3\" contenttype=\"image/png\"/>", "without a path");
    expect("<m:texture2d id=\"3\" path=\"/a.gif\" contenttype=\"image/gif\"/>", "neither image/png");
    expect("<m:texture2dgroup id=\"4\" texid=\"3\"/>", "without a texture");
    expect(colours + "<m:texture2dgroup id=\"4\" texid=\"2\"/>", "without a texture");
    expect("<m:compositematerials id=\"5\" matid=\"1\" matindices=\"0\"/>", "composite materials");
    expect(base + "<m:compositematerials id=\"5\" matid=\"1\"/>", "composite materials");
    expect("<m:multiproperties id=\"6\"/>", "without pids");
    expect(base + composite + "<m:multiproperties id=\"6\" pids=\"1 5\"/>", "more than one material");
    expect(colours + "<m:multiproperties id=\"6\" pids=\"2 2\"/>", "more than one");
    expect(base + "<m:multiproperties id=\"6\" pids=\"1\"/><m:multiproperties id=\"7\" pids=\"6\"/>",
           "consist of multiproperties");
}

} // namespace
} // namespace lamella::three_mf_properties_cases
