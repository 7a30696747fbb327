#include "fixtures/package_checks.hpp"
#include "fixtures/three_mf_files.hpp"
#include "meshes/mesh_readers.hpp"

#include <array>
#include <vector>

namespace lamella::package_test::three_mf_cases {
namespace {

/// Two boxes in one mesh, 12 triangles each; the second one is moved by 10 along x.
std::string two_boxes(std::string_view more = "") {
    std::string mesh = "<mesh><vertices>";
    for (int i = 0; i < 16; ++i)
        mesh +=
            fmt::format("<vertex x=\"{}\" y=\"{}\" z=\"{}\"/>\n", i % 2 + 10 * (i / 8), i / 2 % 2, i / 4 % 2);
    mesh += "</vertices><triangles>";
    for (int box = 0; box < 2; ++box)
        for (const auto& t : std::vector<std::array<int, 3>>{{0, 2, 1},
                                                             {1, 2, 3},
                                                             {4, 5, 6},
                                                             {5, 7, 6},
                                                             {0, 1, 4},
                                                             {1, 5, 4},
                                                             {2, 6, 3},
                                                             {3, 6, 7},
                                                             {0, 4, 2},
                                                             {2, 4, 6},
                                                             {1, 3, 5},
                                                             {3, 7, 5}})
            mesh += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", 8 * box + t[0], 8 * box + t[1],
                                8 * box + t[2]);
    return fmt::format("{}</triangles>{}</mesh>", mesh, more);
}

/// As PrusaSlicer writes it: the second half of the mesh of object 1 has this type.
std::string slic3r_config(std::string_view type, std::string_view key = "volume_type") {
    return fmt::format("<?xml version=\"1.0\"?><config><object id=\"1\"><volume firstid=\"0\" lastid=\"11\">"
                       "<metadata type=\"volume\" key=\"volume_type\" value=\"ModelPart\"/></volume>"
                       "<volume firstid=\"12\" lastid=\"23\"><metadata type=\"volume\" key=\"name\" "
                       "value=\"hole\"/><metadata type=\"volume\" key=\"{}\" value=\"{}\"/></volume></object>"
                       "</config>",
                       key, type);
}

constexpr const char* slic3r_part = "Metadata/Slic3r_PE_model.config";

TEST(ThreeMf, VolumesThatSlic3rMarksAsNoMaterialAreNone) {
    const std::string root = model(object(1, two_boxes()), one_item);
    for (const char* name :
         {slic3r_part, "Metadata/SuperSlicer_model.config", "metadata/slic3r_model.config"})
        for (const auto& [type, role] : {std::pair("ParameterModifier", MeshRole::modifier),
                                         {"SupportBlocker", MeshRole::support_blocker},
                                         {"SupportEnforcer", MeshRole::support_enforcer}}) {
            const std::string bytes = package(root, {{name, slic3r_config(type)}});
            const MeshFile file = read(bytes, {.strict = true});
            ASSERT_EQ(file.instances.size(), 1U);
            EXPECT_EQ(file.stored_triangles, 12U);
            expect_box(file, {0, 0, 0}, {1, 1, 1});
            ASSERT_EQ(file.warnings.size(), 1U);
            EXPECT_EQ(
                file.warnings[0],
                fmt::format("1 body was left out as no material: 1 {} (\"hole\"); `include` {} to read it as "
                            "a solid",
                            row_of(role).name, row_of(role).word));
            ASSERT_EQ(file.bodies.size(), 2U);
            EXPECT_EQ(file.bodies[1].role, role);
            EXPECT_EQ(file.bodies[1].name, "hole");
            EXPECT_TRUE(file.bodies[1].left_out);
            const MeshFile all = read(bytes, {.include = {role}});
            EXPECT_EQ(all.stored_triangles, 24U);
            EXPECT_EQ(all.instances.size(), 1U);
            EXPECT_TRUE(all.warnings.empty());
        }
    EXPECT_EQ(read(package(root, {{slic3r_part, slic3r_config("ModelPart")}})).stored_triangles, 24U);
    EXPECT_EQ(read(package(root, {{slic3r_part, slic3r_config("1", "modifier")}})).stored_triangles, 12U);
}

TEST(ThreeMf, NegativeVolumesBelongToTheObjectThatTheyAreOf) {
    const std::string root =
        model(object(1, two_boxes()) + object(2, box_mesh()), one_item + "<item objectid=\"2\"/>" + one_item);
    const std::string bytes = package(root, {{slic3r_part, slic3r_config("NegativeVolume")}});
    const MeshFile file = read(bytes, {.strict = true});
    ASSERT_EQ(file.objects.size(), 3U);
    ASSERT_EQ(file.instances.size(), 5U);
    const std::vector<bool> negative = {false, true, false, false, true};
    for (std::size_t i = 0; i < 5; ++i)
        EXPECT_EQ(file.instances[i].negative, negative[i]) << i;
    EXPECT_EQ(file.instances[0].body, file.instances[1].body);
    EXPECT_EQ(file.instances[3].body, file.instances[4].body);
    EXPECT_NE(file.instances[0].body, file.instances[3].body);
    EXPECT_NE(file.instances[0].body, file.instances[2].body);
    EXPECT_TRUE(file.warnings.empty());
    const MeshFile solid = read(bytes, {.include = {MeshRole::negative}});
    EXPECT_EQ(solid.instances.size(), 3U);
    EXPECT_EQ(solid.stored_triangles, 36U);
}

TEST(ThreeMf, ComponentsHaveTheRolesThatOrcaSlicerGivesThem) {
    const std::string other =
        model(object(1, box_mesh()) + object(2, box_mesh(2, 2, 2), "type=\"other\""), "");
    const std::string path = "p:path=\"/3D/Objects/a.model\"";
    const std::string root = model(object(3, components({{1, path}, {2, path}})), "<item objectid=\"3\"/>");
    const auto with = [&](std::string_view subtype) {
        return package(root,
                       {{"3D/Objects/a.model", other},
                        {"Metadata/model_settings.config",
                         fmt::format("<config><object id=\"3\"><part id=\"1\" subtype=\"normal_part\"/><part "
                                     "id=\"2\" subtype=\"{}\"><metadata key=\"name\" value=\"cut\"/></part>"
                                     "</object></config>",
                                     subtype)}});
    };
    const MeshFile negative = read(with("negative_part"));
    ASSERT_EQ(negative.instances.size(), 2U);
    EXPECT_TRUE(negative.instances[1].negative);
    EXPECT_TRUE(negative.warnings.empty());
    for (const auto& [subtype, role] : {std::pair("modifier_part", MeshRole::modifier),
                                        {"support_blocker", MeshRole::support_blocker},
                                        {"support_enforcer", MeshRole::support_enforcer}}) {
        const MeshFile file = read(with(subtype));
        EXPECT_EQ(file.instances.size(), 1U);
        EXPECT_EQ(file.warnings.at(0),
                  fmt::format("1 body was left out as no material: 1 {} (\"cut\"); `include` {} "
                              "to read it as a solid",
                              row_of(role).name, row_of(role).word));
        EXPECT_EQ(read(with(subtype), {.include = {role}}).instances.size(), 2U);
    }
    EXPECT_EQ(read(with("normal_part")).instances.size(), 2U);
    EXPECT_TRUE(
        says(read(with("strange_part")).warnings.at(0), "1 volume is of an unknown type ('strange_part')"));
}

TEST(ThreeMf, VolumesOfSlic3rMayStandInTheMesh) {
    const std::string volumes = "<s:volumes><s:volume ts=\"0\" te=\"11\" modifier=\"0\"/><s:volume ts=\"12\" "
                                "te=\"23\" modifier=\"1\"/></s:volumes>";
    const MeshFile file = read(package(
        model(object(1, two_boxes(volumes)), one_item, "xmlns:s=\"http://schemas.slic3r.org/3mf/2017/06\"")));
    EXPECT_EQ(file.stored_triangles, 12U);
    EXPECT_TRUE(says(file.warnings.at(0), "1 modifier"));
}

TEST(ThreeMf, RolesThatCannotBeReadAreReportedAndHostileOnesHarmNothing) {
    const std::string root = model(object(1, two_boxes()), one_item);
    const auto with = [&](std::string_view config) {
        return package(root, {{slic3r_part, std::string(config)}});
    };
    EXPECT_TRUE(says(read(with("<config><object")).warnings.at(0), "what volumes are for cannot be read"));
    EXPECT_TRUE(
        says(error_of(with("<config><object"), ErrorKind::defect, {.strict = true}), "cannot be read"));
    const std::string volume = "<volume firstid=\"{}\" lastid=\"{}\"><metadata key=\"modifier\" "
                               "value=\"1\"/></volume>";
    const auto ranges = [&](const std::vector<std::pair<std::uint64_t, std::uint64_t>>& all) {
        std::string text = "<config><object id=\"1\">";
        for (const auto& [first, last] : all)
            text += fmt::format(fmt::runtime(volume), first, last);
        return text + "</object></config>";
    };
    EXPECT_EQ(read(with(ranges({{12, 4'000'000'000}}))).stored_triangles, 12U);
    EXPECT_EQ(read(with(ranges({{18, 23}, {12, 20}, {14, 15}}))).stored_triangles, 12U);
    EXPECT_EQ(read(with(ranges({{30, 40}}))).stored_triangles, 24U);
    EXPECT_EQ(read(with(ranges({{5, 2}}))).stored_triangles, 24U);
    EXPECT_TRUE(says(error_of(with(ranges({{0, 23}}))), "holds nothing to slice"));
    EXPECT_TRUE(says(error_of(with(replaced(replaced(ranges({{0, 23}}), "modifier", "volume_type"), "\"1\"/>",
                                            "\"NegativeVolume\"/>"))),
                     "holds nothing to slice: nothing but negative volumes"));
}

} // namespace
} // namespace lamella::package_test::three_mf_cases
