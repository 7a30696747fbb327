#include "fixtures/package_checks.hpp"
#include "fixtures/three_mf_files.hpp"
#include "meshes/mesh_readers.hpp"

#include <vector>

namespace lamella::package_test::three_mf_cases {
namespace {

using zip_test::zip_bytes;

TEST(ThreeMf, PathsLeadFromTheRootToPartsThatAreThere) {
    const std::string leaf = model(object(1, box_mesh()), "");
    const std::string root = model("", "<item objectid=\"1\" p:path=\"/3D/a.model\"/>");
    EXPECT_EQ(read(package(root, {{"3D/a.model", leaf}})).instances.size(), 1U);
    EXPECT_EQ(
        read(package(replaced(root, "/3D/a.model", "a.model"), {{"3D/a.model", leaf}})).instances.size(), 1U);
    EXPECT_TRUE(
        says(error_of(package(root)), "refers to the part '3D/a.model', which is not in the package"));
    EXPECT_TRUE(says(error_of(package(replaced(root, "\"1\"", "\"7\""), {{"3D/a.model", leaf}})),
                     "found objectid 7, but there is no such object in '3D/a.model'"));
    const std::string deeper = model(object(1, components({{1, "p:path=\"/3D/b.model\""}})), "");
    EXPECT_TRUE(
        says(error_of(package(root, {{"3D/a.model", deeper}, {"3D/b.model", leaf}})),
             "x, part '3D/a.model', line 3: found path '/3D/b.model' in a part that is not the root"));
}

TEST(ThreeMf, FindsTheRootByItsRelationshipAndElseByItsName) {
    const std::string text = model(object(1, box_mesh()), one_item);
    const auto with = [&](const std::vector<std::pair<std::string, std::string>>& parts) {
        std::vector<zip_test::ZipPart> list = {{.name = "[Content_Types].xml", .content = content_types}};
        for (const auto& [name, content] : parts)
            list.push_back({.name = name, .content = content});
        return zip_bytes(list);
    };
    for (const char* target : {"/x/y.bin", "x/y.bin", "/x/./z/../y%2Ebin", "X/Y.BIN"})
        EXPECT_EQ(read(with({{"_rels/.rels", relationships({target})}, {"x/y.bin", text}}), {.strict = true})
                      .instances.size(),
                  1U)
            << target;
    // The archive may have names as references write them, or as they read.
    for (const char* name : {"x/my%20part.model", "x/my part.model"})
        EXPECT_EQ(read(with({{"_rels/.rels", relationships({"/x/my%20part.model"})}, {name, text}}))
                      .instances.size(),
                  1U)
            << name;
    EXPECT_TRUE(says(read(with({{"3D/3dmodel.model", text}, {"a.model", "?"}})).warnings.at(0),
                     "took '3D/3dmodel.model'"));
    EXPECT_TRUE(says(read(with({{"other.model", text}})).warnings.at(0), "took 'other.model'"));
    EXPECT_TRUE(
        says(read(zip_bytes({{.name = "3d\\3DModel.model", .content = text}})).warnings.at(0), "'\\'"));
    EXPECT_TRUE(says(error_of(with({{"_rels/.rels", relationships({"/a", "/b"})}, {"a", text}, {"b", text}})),
                     "names 2 models ('a', 'b'), expected one"));
    EXPECT_TRUE(says(error_of(with({{"_rels/.rels", relationships({"/a"})}, {"3D/3dmodel.model", text}})),
                     "names the model 'a', which is not in it"));
    EXPECT_TRUE(says(error_of(with({{"_rels/.rels", replaced(relationships({"http://a"}), "Target=",
                                                             "TargetMode=\"External\" Target=")}})),
                     "the model lies outside of the package"));
    EXPECT_TRUE(
        says(error_of(with({{"_rels/.rels", "<Relationships"}})), "x, part '_rels/.rels', line 1: the XML"));
    EXPECT_TRUE(says(error_of(with({{"readme.txt", text}, {"part.stl", "solid"}})),
                     "is a zip archive without a model"));
}

} // namespace
} // namespace lamella::package_test::three_mf_cases
