#include "fixtures/package_checks.hpp"
#include "meshes/remarks.hpp"
#include "meshes/role_gaps.hpp"

#include <string>
#include <vector>

namespace lamella::package_test::role_gaps_cases {
namespace {

std::vector<std::string> remarks_of(const RoleGaps& gaps) {
    Remarks remarks("x", false);
    gaps.report(remarks);
    return remarks.take();
}

TEST(RoleGaps, AreTrianglesBeyondAndBetweenTheVolumes) {
    RoleGaps none;
    none.compare(1, std::vector<VolumeRange>{{12, 24, MeshRole::negative}, {0, 12}}, 24);
    none.compare(2, {}, 24); // without roles, all triangles are parts
    none.add_absent(3, MeshRole::part);
    EXPECT_TRUE(remarks_of(none).empty());

    RoleGaps some;
    some.compare(4, std::vector<VolumeRange>{{2, 5}, {3, 7}, {9, 13, MeshRole::modifier}}, 12);
    some.compare(5, std::vector<VolumeRange>{{20, 30, MeshRole::negative}}, 12);
    const std::vector<std::string> found = remarks_of(some);
    ASSERT_EQ(found.size(), 2U);
    EXPECT_TRUE(found[0].starts_with("the roles of 2 bodies are for triangles or objects that are not in the "
                                     "file (the first: a modifier of object 4)"))
        << found[0];
    EXPECT_TRUE(found[1].starts_with("16 triangles without a role, taken as those of parts, of objects whose "
                                     "roles the file lists (the first: object 4)"))
        << found[1];
}

/// A box, and a second one for which this configuration has the role.
std::string package_with(const std::string& config) {
    return package(
        model(object(1, box_mesh()) + object(2, box_mesh()) + object(3, components({{1, ""}, {2, ""}})),
              "<item objectid=\"3\"/>"),
        {{"Metadata/model_settings.config", "<config>" + config + "</config>"}});
}

TEST(RoleGaps, OfAbsentObjectsAndComponentsAreWarnings) {
    const std::string both =
        "<part id=\"1\" subtype=\"normal_part\"/><part id=\"2\" subtype=\"negative_part\"/>";
    EXPECT_TRUE(
        read(package_with("<object id=\"3\">" + both + "</object>"), {.strict = true}).warnings.empty());
    for (const auto& [config, warning] :
         {std::pair("<object id=\"8\">" + both + "</object>",
                    "the roles of 1 body are for triangles or objects that are not in the file"),
          {"<object id=\"3\">" + replaced(both, "\"2\"", "\"5\"") + "</object>",
           "(the first: a negative volume of object 3)"},
          {"<object id=\"7\"><volume firstid=\"0\" lastid=\"11\"><metadata key=\"volume_type\" "
           "value=\"NegativeVolume\"/></volume></object>",
           "(the first: a negative volume of object 7)"},
          {"<object id=\"3\"><part id=\"2\" subtype=\"modifier_part\"/></object>",
           "1 component without a role, taken as a part, of objects whose roles the file lists"}}) {
        const std::string bytes = package_with(config);
        EXPECT_TRUE(says(read(bytes).warnings.at(0), warning)) << config;
        EXPECT_TRUE(says(error_of(bytes, ErrorKind::defect, {.strict = true}), warning)) << config;
    }
    // Roles of parts change nothing.
    EXPECT_TRUE(read(package_with("<object id=\"8\"><part id=\"1\" subtype=\"normal_part\"/></object>"))
                    .warnings.empty());
}

} // namespace
} // namespace lamella::package_test::role_gaps_cases
