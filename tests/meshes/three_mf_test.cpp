#include "container/in_memory.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/package_checks.hpp"
#include "fixtures/three_mf_files.hpp"
#include "meshes/mesh_readers.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <vector>

namespace lamella::package_test::three_mf_cases {
namespace {

using zip_test::zip_bytes;

TEST(ThreeMf, ReadsAMeshAsTheFileHasIt) {
    const MeshFile file =
        read(package(model("<!-- a box -->" + object(1, box_mesh(), "name=\"a &lt;box&gt;\""), one_item)));
    EXPECT_EQ(file.format, "3mf");
    ASSERT_EQ(file.objects.size(), 1U);
    ASSERT_EQ(file.instances.size(), 1U);
    EXPECT_EQ(file.objects[0].name, "a <box>");
    EXPECT_EQ(file.instances[0].name, "a <box>");
    EXPECT_EQ(file.name, "a <box>");
    EXPECT_EQ(file.stored_triangles, 12U);
    EXPECT_EQ(file.unit_mm, 1.0);
    ASSERT_NE(file.objects[0].mesh.indexed(), nullptr);
    const IndexedMesh& mesh = *file.objects[0].mesh.indexed();
    EXPECT_EQ(mesh.vertices.size(), 8U);
    EXPECT_EQ(mesh.vertices[5], (Point3{1, 0, 3}));
    EXPECT_EQ(mesh.triangles[1], (std::array<std::uint32_t, 3>{1, 2, 3}));
    EXPECT_DOUBLE_EQ(volume(file.mesh()), 6);
    EXPECT_TRUE(file.warnings.empty());
}

TEST(ThreeMf, LeavesPackagesWhosePartsMentionSlicesToTheirReader) {
    const auto is_read = [](const std::string& attributes_of_root, const std::string& attributes_of_leaf) {
        const std::string bytes =
            package(model(object(1, box_mesh()), one_item + "<item objectid=\"7\" p:path=\"/3D/a.model\"/>",
                          attributes_of_root),
                    {{"3D/a.model", model(object(7, box_mesh()), "", attributes_of_leaf)}});
        return read_three_mf_without_slices(test::source_of(bytes), {}, {}).has_value();
    };
    const std::string slices = "xmlns:t=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\"";
    EXPECT_TRUE(is_read("", ""));
    EXPECT_FALSE(is_read(slices, ""));
    EXPECT_FALSE(is_read("", slices));
}

TEST(ThreeMf, MirroredInstancesStaySolid) {
    const MeshFile file = read(package(model(
        object(1, box_mesh()), one_item + "<item objectid=\"1\" transform=\"-1 0 0 0 1 0 0 0 1 0 0 0\"/>")));
    ASSERT_EQ(file.instances.size(), 2U);
    EXPECT_EQ(file.instances[0].object, file.instances[1].object) << "instances share their mesh";
    EXPECT_DOUBLE_EQ(volume(file.placed(0)), 6);
    EXPECT_DOUBLE_EQ(volume(file.placed(1)), 6);
}

TEST(ThreeMf, EachWayFromTheBuildToAMeshIsAnInstance) {
    const std::string resources =
        object(1, box_mesh(), "name=\"box\"") + object(2, box_mesh(2, 2, 2)) +
        object(3, components({{1, ""}, {2, "transform=\"1 0 0 0 1 0 0 0 1 5 0 0\""}}), "name=\"pair\"") +
        object(4, components({{3, ""}, {3, "transform=\"1 0 0 0 1 0 0 0 1 0 9 0\""}, {1, ""}})) +
        object(9, box_mesh());
    const MeshFile file = read(package(model(resources, "<item objectid=\"4\"/><item objectid=\"2\"/>")));
    EXPECT_EQ(file.objects.size(), 2U) << "what is not used is left out";
    ASSERT_EQ(file.instances.size(), 6U);
    const std::vector<std::pair<std::size_t, std::string>> expected = {{0, "box"},  {1, "pair"}, {0, "box"},
                                                                       {1, "pair"}, {0, "box"},  {1, ""}};
    for (std::size_t i = 0; i < expected.size(); ++i) {
        EXPECT_EQ(file.instances[i].object, expected[i].first) << i;
        EXPECT_EQ(file.instances[i].name, expected[i].second) << i;
    }
    EXPECT_DOUBLE_EQ(volume(file.mesh()), 3 * 6 + 3 * 8);
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_EQ(file.warnings[0], "1 object is not in the build; it was left out");
}

TEST(ThreeMf, WhatASupportConsistsOfIsSupport) {
    const MeshFile file =
        read(package(model(object(1, box_mesh()) + object(2, components({{1, ""}}), "type=\"support\""),
                           one_item + "<item objectid=\"2\"/>")),
             {.include = {MeshRole::support}});
    ASSERT_EQ(file.instances.size(), 2U);
    EXPECT_EQ(file.objects.size(), 1U);
    EXPECT_FALSE(file.instances[0].support);
    EXPECT_TRUE(file.instances[1].support);
}

TEST(ThreeMf, InstancesAreCountedBeforeMemoryIsTaken) {
    std::string resources = object(1, box_mesh());
    for (int i = 2; i < 18; ++i)
        resources += object(i, components({{i - 1, ""}, {i - 1, ""}}));
    EXPECT_TRUE(
        says(error_of(package(model(resources, "<item objectid=\"17\"/>")), ErrorKind::limit,
                      {.max_memory = 50'000'000}),
             "takes more than the 50000000 bytes of `max_memory` (counted up to 65536 meshes that are put on "
             "the plate)"));
}

TEST(ThreeMf, ProductionFilesHaveManyPartsWithUnitsOfTheirOwn) {
    const std::string other =
        model(object(1, box_mesh()) + object(5, components({{1, ""}})), "", "unit=\"inch\"");
    const std::string root = model(
        object(2, box_mesh()) + object(3, components({{2, ""},
                                                      {5, "p:path=\"/3D/Objects/a.model\" "
                                                          "transform=\"1 0 0 0 1 0 0 0 1 1 0 0\""}})),
        "<item objectid=\"3\"/><item objectid=\"1\" p:path=\"/3D/Objects/b.model\"/>", "unit=\"centimeter\"");
    for (const unsigned threads : {1U, 3U}) {
        const MeshFile file =
            read(package(root, {{"3D/Objects/a.model", other}, {"3D/Objects/b.model", other}}),
                 {.strict = true}, threads);
        EXPECT_EQ(file.unit_mm, 10.0);
        ASSERT_EQ(file.objects.size(), 3U);
        ASSERT_EQ(file.instances.size(), 3U);
        EXPECT_DOUBLE_EQ(volume(file.placed(0)), 6 * 1000);
        EXPECT_NEAR(volume(file.placed(1)), 6 * 25.4 * 25.4 * 25.4, 1e-6);
        EXPECT_NEAR(bounding_box(file.placed(1)).min.x, 10, 1e-12);
        EXPECT_NEAR(bounding_box(file.placed(1)).max.z, 3 * 25.4, 1e-12);
        EXPECT_NEAR(volume(file.placed(2)), 6 * 25.4 * 25.4 * 25.4, 1e-6);
    }
}

TEST(ThreeMf, ReferencesThatLeadNowhereAreCounted) {
    const std::string lost =
        replaced(relationships({"/3D/a", "/3D/b"}), "2013/01/3dmodel", "2013/01/another");
    const std::string bytes =
        zip_bytes({{.name = "[Content_Types].xml", .content = content_types},
                   {.name = "_rels/.rels", .content = relationships({"/3D/3dmodel.model"})},
                   {.name = "3D/_rels/3dmodel.model.rels", .content = lost},
                   {.name = "3D/3dmodel.model",
                    .content = model("", "<item objectid=\"1\" p:path=\"/3D/other.model\"/>")},
                   {.name = "3D/other.model", .content = model(object(1, box_mesh()), "")}});
    const MeshFile file = read(bytes);
    ASSERT_EQ(file.warnings.size(), 2U);
    EXPECT_EQ(file.warnings[0], "2 references of the package lead to no part of it (the first is '3D/a')");
    EXPECT_EQ(file.warnings[1], "the part '3D/other.model' is used without a relationship to it");
}

TEST(ThreeMf, ObjectsThatContainThemselvesAreRefused) {
    EXPECT_TRUE(
        says(error_of(package(model(object(1, components({{1, ""}})), one_item))), "contains itself"));
    EXPECT_TRUE(
        says(error_of(package(model(object(3, box_mesh()) + object(1, components({{3, ""}, {2, ""}})) +
                                        object(2, components({{1, ""}})),
                                    "<item objectid=\"3\"/>"))),
             "object 1: contains itself"));
}

// 2^60 boxes, written in 60 lines.
TEST(ThreeMf, ABillionLaughsAreCountedAndNotMade) {
    std::string resources = object(1, box_mesh());
    for (int i = 2; i < 62; ++i)
        resources += object(i, components({{i - 1, ""}, {i - 1, ""}}));
    const auto building = [&](int id, const MeshReadOptions& options = {}) {
        return error_of(package(model(resources, fmt::format("<item objectid=\"{}\"/>", id))),
                        ErrorKind::limit, options);
    };
    EXPECT_EQ(building(9), "");
    EXPECT_TRUE(
        says(building(61), "puts 1152921504606846976 meshes on the plate, at most 1048576 are taken"));
    EXPECT_TRUE(says(building(22), "puts 2097152 meshes"));
    EXPECT_EQ(building(9, {.max_triangles = 256 * 12}), "");
    EXPECT_TRUE(says(building(9, {.max_triangles = 256 * 12 - 1}), "`max_triangles`"));
    EXPECT_TRUE(says(building(9, {.max_memory = 20'000}), "`max_memory`"));
}

TEST(ThreeMf, NestingHasALimit) {
    const auto nested = [](int depth) {
        std::string resources = object(1, box_mesh());
        for (int i = 2; i <= depth; ++i)
            resources += object(i, components({{i - 1, ""}}));
        return package(model(resources, fmt::format("<item objectid=\"{}\"/>", depth)));
    };
    EXPECT_EQ(error_of(nested(60)), "");
    EXPECT_TRUE(says(error_of(nested(80)), "is nested deeper than 64"));
    EXPECT_TRUE(says(error_of(nested(5000)), "is nested deeper than 64"));
}

TEST(ThreeMf, StrictReadersGetWhatBreaksTheRules) {
    const std::string good = model(object(1, box_mesh()), one_item);
    const auto strict = [](const std::string& bytes) {
        EXPECT_EQ(error_of(bytes), "");
        return error_of(bytes, ErrorKind::defect, {.strict = true});
    };
    EXPECT_EQ(strict(package(good)), "");
    EXPECT_TRUE(says(strict(package(replaced(good, "<build>", "<thing/><build>"))), "found <thing>"));
    EXPECT_TRUE(
        says(strict(package(replaced(good, "<build>", "<metadata/><build>"))), "metadata without a name"));
    EXPECT_TRUE(says(strict(package(replaced(good, "v1=\"0\" v2=\"2\"", "v1=\"2\" v2=\"2\""))),
                     "1 triangle uses a vertex twice"));
    EXPECT_TRUE(
        says(strict(zip_bytes({{.name = "_rels/.rels", .content = relationships({"3D/3dmodel.model"})},
                               {.name = "3D/3dmodel.model", .content = good}})),
             "[Content_Types].xml"));
    EXPECT_TRUE(says(strict(package(good) + "junk"), "4 bytes follow the end"));
}

TEST(ThreeMf, MemoryIsLimitedAndTheErrorNamesTheOption) {
    const std::string bytes = package(model(object(1, box_mesh()) + std::string(100'000, ' '), one_item));
    EXPECT_EQ(error_of(bytes, ErrorKind::limit, {.max_memory = 200'000}), "");
    EXPECT_TRUE(says(error_of(bytes, ErrorKind::limit, {.max_memory = 100'000}), "`max_memory`"));
}

TEST(ThreeMf, PackedBombsStopAtTheLimit) {
    const std::string bomb = package(model(std::string(8'000'000, ' '), one_item));
    EXPECT_LT(bomb.size(), 500'000U);
    EXPECT_TRUE(says(error_of(bomb, ErrorKind::limit, {.max_memory = 1'000'000}), "`max_memory`"));
}

TEST(ThreeMf, LongMeshesAreTheSameForAnyThreads) {
    // Long enough for several pieces; each vertex tells its index.
    std::string mesh = "<mesh><vertices>";
    constexpr int count = 150'000;
    for (int i = 0; i < count; ++i)
        mesh += fmt::format("<vertex x=\"{}\" y=\"{}.25\" z=\"-1e-3\"/>\n", i, count - i);
    mesh += "</vertices><triangles>";
    for (int i = 0; i + 2 < count; ++i)
        mesh += fmt::format("<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"/>\n", i, i + 1, i + 2);
    mesh += "</triangles></mesh>";
    const std::string bytes = package(model(object(1, mesh), one_item));
    for (const unsigned threads : {1U, 2U, 7U}) {
        const MeshFile file = read(bytes, {}, threads);
        const IndexedMesh& read_mesh = *file.objects[0].mesh.indexed();
        ASSERT_EQ(read_mesh.vertices.size(), static_cast<std::size_t>(count));
        ASSERT_EQ(read_mesh.triangles.size(), static_cast<std::size_t>(count - 2));
        for (int i = 0; i < count; i += 331) {
            EXPECT_EQ(read_mesh.vertices[i], (Point3{double(i), count - i + 0.25, -1e-3}));
            EXPECT_EQ(read_mesh.triangles[std::min(i, count - 3)][2],
                      static_cast<unsigned>(std::min(i, count - 3) + 2));
        }
    }
    // Whatever is odd in the middle is found, and its line with it.
    EXPECT_TRUE(says(error_of(package(model(object(1, replaced(mesh, "x=\"70000\"", "x=\"!\"")), one_item))),
                     "line 70003: found x = '!'"));
}

TEST(ThreeMf, EveryPrefixOfAPackageIsRefused) {
    const std::string whole = package(model(object(1, box_mesh()), one_item));
    for (std::size_t size = 1; size < whole.size(); ++size)
        EXPECT_FALSE(survive(whole.substr(0, size)).has_value()) << size;
}

TEST(ThreeMf, SurvivesMutations) {
    std::mt19937 random(20'23);
    const std::string leaf = model(object(1, box_mesh()), "");
    const std::string root =
        model(object(2, box_mesh(), "name=\"part\" type=\"model\"") +
                  object(3, components({{2, ""}, {2, "transform=\"1 0 0 0 1 0 0 0 1 5 5 5\""}})),
              "<item objectid=\"3\"/><item objectid=\"1\" p:path=\"/3D/a.model\"/>", "unit=\"inch\"");
    constexpr std::string_view words[] = {"<vertex x=\"1\" y=\"2\" z=\"3\"/>",
                                          "</vertices>",
                                          "<triangles>",
                                          "<!--",
                                          "-->",
                                          "<![CDATA[",
                                          "]]>",
                                          "\"",
                                          "&amp;",
                                          "&#0;",
                                          "nan",
                                          "1e400",
                                          "-1",
                                          "4294967296",
                                          "<component objectid=\"3\"/>",
                                          "xmlns=\"\"",
                                          "<p:x/>",
                                          "transform=\"0 0 0 0 0 0 0 0 0 0 0 0\"",
                                          "</object>",
                                          "\xff",
                                          "\r"};
    std::size_t read_anyway = 0;
    for (int round = 0; round < 8000; ++round) {
        const std::string changed = mutated(root, random, words);
        read_anyway += survive(package(changed, {{"3D/a.model", leaf}}, false)).has_value() ? 1 : 0;
    }
    EXPECT_GT(read_anyway, 150U) << "the mutations are so wild that they test nothing";
    const std::string bytes = package(root, {{"3D/a.model", leaf}});
    for (int round = 0; round < 3000; ++round)
        survive(mutated(bytes, random, words));
}

/// Files of public projects, where they are at hand.
struct Sample {
    std::filesystem::path path;
    std::string name;
};

std::vector<Sample> samples(const std::string& folder) {
    std::vector<Sample> found;
    const std::filesystem::path top = std::filesystem::path(LAMELLA_SHARED) / "formats/samples" / folder;
    if (std::filesystem::exists(top))
        for (const auto& entry : std::filesystem::recursive_directory_iterator(top))
            if (entry.path().extension() == ".3mf")
                found.push_back({entry.path(), entry.path().stem().string()});
    return found;
}

TEST(ThreeMfSamples, FilesOfTheConsortiumAreReadWithoutAWord) {
    std::size_t count = 0;
    for (const char* folder : {"3mf-core", "3mf-production"})
        for (const Sample& sample : samples(folder)) {
            const MeshFile file = read_mesh(sample.path.string(), {.strict = true});
            EXPECT_TRUE(file.warnings.empty()) << sample.name;
            EXPECT_GT(volume(file.mesh()), 0) << sample.name;
            ++count;
        }
    if (count == 0)
        GTEST_SKIP() << "no samples in " << LAMELLA_SHARED;
    EXPECT_EQ(count, 12U);
}

TEST(ThreeMfSamples, WhatMustPassPassesStrictly) {
    std::size_t count = 0;
    for (const Sample& sample : samples("3mf-validation"))
        if (sample.name.starts_with("MUSTPASS")) {
            EXPECT_NO_THROW(static_cast<void>(read_mesh(sample.path.string(), {.strict = true})))
                << sample.name;
            ++count;
        }
    if (count == 0)
        GTEST_SKIP() << "no samples in " << LAMELLA_SHARED;
}

// Two of the archive contradict others or the present specification.
TEST(ThreeMfSamples, WhatMustFailIsRefusedStrictly) {
    std::size_t count = 0;
    for (const Sample& sample : samples("3mf-validation")) {
        if (!sample.name.starts_with("MUSTFAIL"))
            continue;
        ++count;
        const bool allowed =
            sample.name.ends_with("2.3.2c_UndefinedNameSpaceInXDS") || // attributes of others are ignored
            sample.name.ends_with("3.4.1a_MissingMetadataName");       // as MUSTPASS 3.4.1c does it
        if (allowed)
            EXPECT_NO_THROW(static_cast<void>(read_mesh(sample.path.string(), {.strict = true})))
                << sample.name;
        else
            EXPECT_THROW(static_cast<void>(read_mesh(sample.path.string(), {.strict = true})), Error)
                << sample.name;
    }
    if (count == 0)
        GTEST_SKIP() << "no samples in " << LAMELLA_SHARED;
    EXPECT_EQ(count, 38U);
}

/// A box of 10 mm that is only a substitute, with this content of <alternatives>.
std::string substitute(std::string_view resolution, std::string_view alternatives,
                       std::string_view more = "") {
    constexpr const char* space =
        "xmlns:pa=\"http://schemas.microsoft.com/3dmanufacturing/production/alternatives/2021/04\"";
    return model(object(1, box_mesh(10, 10, 10) + std::string(alternatives),
                        fmt::format("pa:modelresolution=\"{}\"", resolution)) +
                     std::string(more),
                 one_item, fmt::format("{} requiredextensions=\"p pa\"", space));
}

TEST(ThreeMf, SubstitutesAreReplacedByTheirAlternativesInFullResolution) {
    const std::string other = model(object(7, box_mesh(3, 3, 10)), "");
    const auto in = [](std::string_view attributes) {
        return fmt::format("<pa:alternatives><pa:alternative objectid=\"9\" modelresolution=\"lowres\"/>"
                           "<pa:alternative {}/></pa:alternatives>",
                           attributes);
    };
    const std::string in_part = in("objectid=\"7\" path=\"/3D/full.model\" modelresolution=\"fullres\"");
    for (const char* resolution : {"obfuscated", "lowres"}) {
        const std::vector<std::string> packages = {
            package(substitute(resolution, in_part), {{"3D/full.model", other}}),
            package(substitute(resolution, replaced(in_part, " path", " pa:path")),
                    {{"3D/full.model", other}}),
            package(substitute(resolution, in("objectid=\"7\""), object(7, box_mesh(3, 3, 10))))};
        for (const std::string& bytes : packages) {
            const MeshFile file = read(bytes, {.strict = true});
            ASSERT_EQ(file.instances.size(), 1U);
            EXPECT_DOUBLE_EQ(volume(file.mesh()), 90);
        }
        EXPECT_TRUE(says(error_of(package(substitute(resolution, ""))),
                         fmt::format("object 1: its resolution is '{}', so it only stands in", resolution)));
    }
    EXPECT_DOUBLE_EQ(volume(read(package(substitute("fullres", in_part), {{"3D/full.model", other}})).mesh()),
                     1000);
    EXPECT_TRUE(says(error_of(package(substitute("lowres", in_part))), "refers to the part '3D/full.model'"));
}

TEST(ThreeMf, ExtensionsInsteadOfMeshesAreNamed) {
    const std::string bytes = package(
        model(object(1, box_mesh()) + object(2, "<bo:booleanshape objectid=\"1\" operation=\"union\"/>"),
              one_item, "xmlns:bo=\"http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07\""));
    EXPECT_TRUE(says(error_of(bytes),
                     "object 2 with neither a mesh nor components but with <booleanshape> of "
                     "'http://schemas.3mf.io/3dmanufacturing/booleanoperations/2023/07'"));
}

TEST(ThreeMf, BodiesThatAreNoMaterialAreNamedIfThereAreNoOthers) {
    const std::string bytes =
        package(model(object(1, box_mesh(), "type=\"surface\" name=\"skin\""), one_item));
    EXPECT_TRUE(says(error_of(bytes), "holds nothing to slice: its only body is no material: 1 surface "
                                      "(\"skin\"); `include` surface to read it as a solid"));
    EXPECT_EQ(read(bytes, {.include = {MeshRole::surface}}).instances.size(), 1U);
}

TEST(ThreeMf, OneMeshNeverHidesNegativeVolumes) {
    const std::string bytes = package(
        model(object(1, box_mesh()) + object(2, box_mesh()) + object(3, components({{1, ""}, {2, ""}})),
              "<item objectid=\"3\"/>"),
        {{"Metadata/model_settings.config",
          "<config><object id=\"3\"><part id=\"1\" subtype=\"normal_part\"/>"
          "<part id=\"2\" subtype=\"negative_part\"/></object></config>"}});
    const MeshFile file = read(bytes);
    test::expect_error(ErrorKind::usage, {"x: has negative volumes", "`include` negative"},
                       [&] { (void)file.mesh(); });
    EXPECT_EQ(read(bytes, {.include = {MeshRole::negative}}).mesh().size(), 24U);
}

} // namespace
} // namespace lamella::package_test::three_mf_cases
