#include "fixtures/package_checks.hpp"
#include "fixtures/skip_if_slowed.hpp"
#include "meshes/amf_files.hpp"
#include "meshes/mesh_readers.hpp"

#include <filesystem>

namespace lamella::package_test::amf_cases {
namespace {

using zip_test::zip_bytes;

TEST(Amf, ReadsAMeshAsTheFileHasIt) {
    const MeshFile file = read(amf("<metadata type=\"name\"> A file </metadata>" +
                                   amf_object("0", "<metadata type=\"name\">a &amp; b</metadata>")));
    EXPECT_EQ(file.format, "amf");
    EXPECT_EQ(file.name, "A file");
    ASSERT_EQ(file.objects.size(), 1U);
    ASSERT_EQ(file.instances.size(), 1U);
    EXPECT_EQ(file.objects[0].name, "a & b");
    EXPECT_EQ(file.instances[0].name, "a & b");
    EXPECT_EQ(file.stored_triangles, 4U);
    EXPECT_FALSE(file.unit_mm.has_value()) << "the file states none";
    const IndexedMesh& mesh = *file.objects[0].mesh.indexed();
    EXPECT_EQ(mesh.vertices[3], (Point3{0, 0, 1}));
    EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 2, 1}));
    EXPECT_NEAR(volume(file.mesh()), 1.0 / 6, 1e-15);
    EXPECT_TRUE(file.warnings.empty());
}

TEST(Amf, UnitsScaleMeshesAndPlacements) {
    for (const auto& [unit, mm] : {std::pair("millimeter", 1.0),
                                   {"inch", 25.4},
                                   {"feet", 304.8},
                                   {"meter", 1000.0},
                                   {"micron", 0.001},
                                   {"Millimeters", 1.0},
                                   {"FOOT", 304.8},
                                   {"micrometer", 0.001},
                                   {"in", 25.4},
                                   {"ft", 304.8},
                                   {"m", 1000.0},
                                   {"cm", 10.0},
                                   {"um", 0.001},
                                   {"\xc2\xb5m", 0.001},
                                   {"metre", 1000.0}}) {
        const MeshFile file =
            read(amf(amf_object("0") + constellation("1", instance("0", "<deltax>2</deltax>")),
                     fmt::format("unit=\"{}\"", unit)));
        EXPECT_EQ(file.unit_mm, mm);
        expect_box(file, {2 * mm, 0, 0}, {3 * mm, mm, mm});
    }
    EXPECT_TRUE(says(error_of(amf(amf_object("0"), "unit=\"mile\"")),
                     "x, line 2: found unit 'mile', expected millimeter"));
}

TEST(Amf, ConstellationsTurnAboutXThenYThenZAndMove) {
    const MeshFile file = read(
        amf(amf_object("0") + constellation("1", instance("0", "<rx>90</rx><rz>90</rz><deltaz>5</deltaz>"))));
    // x: (x, y, z) -> (x, -z, y); z: (x, y, z) -> (-y, x, z). Exactly.
    EXPECT_EQ(bounding_box(file.mesh()).min, (Point3{0, 0, 5}));
    EXPECT_EQ(bounding_box(file.mesh()).max, (Point3{1, 1, 6}));
    EXPECT_EQ(file.placed(0).indexed()->vertices[3], (Point3{1, 0, 5}));
}

TEST(Amf, AnglesAreRadiansInFilesOfSlic3rAndItsDescendants) {
    for (const char* sign : {"<metadata type=\"cad\">Slic3r 1.3.0</metadata>",
                             "<metadata type=\"cad\">PrusaSlicer 2.5.0</metadata>",
                             "<metadata type=\"slic3rpe_amf_version\">1</metadata>"}) {
        const MeshFile file = read(
            amf(sign + amf_object("0") + constellation("1", instance("0", "<rz>1.5707963267948966</rz>"))));
        expect_box(file, {-1, 0, 0}, {0, 1, 1});
    }
    const MeshFile file = read(amf("<metadata type=\"cad\">Another</metadata>" + amf_object("0") +
                                   constellation("1", instance("0", "<rz>90</rz>"))));
    expect_box(file, {-1, 0, 0}, {0, 1, 1});
}

TEST(Amf, ScaleAndMirrorAreHonoured) {
    const MeshFile file = read(
        amf(amf_object("0") +
            constellation(
                "1",
                instance("0", "<scale>2</scale><scaley>3</scaley><mirrorx>-1</mirrorx><deltaz>1</deltaz>"))));
    expect_box(file, {-2, 0, 1}, {0, 6, 3});
    EXPECT_NEAR(volume(file.mesh()), 24.0 / 6, 1e-12);
    EXPECT_TRUE(says(error_of(amf(amf_object("0") + constellation("1", instance("0", "<scale>0</scale>")))),
                     "x: line 11: found a scale of 0"));
}

TEST(Amf, ObjectsThatNothingPlacesStandWhereTheyAre) {
    const MeshFile file = read(amf(amf_object("a") + amf_object("b") +
                                   constellation("c", instance("b") + instance("b", "<deltax>9</deltax>")) +
                                   constellation("d", instance("c", "<deltay>7</deltay>"))));
    ASSERT_EQ(file.objects.size(), 2U);
    ASSERT_EQ(file.instances.size(), 3U);
    EXPECT_EQ(file.instances[0].object, 0U);
    EXPECT_EQ(file.instances[2].object, 1U);
    EXPECT_EQ(file.instances[2].placement.offset, (std::array<double, 3>{9, 7, 0}));
}

TEST(Amf, ObjectsAndConstellationsMayShareIdsAsSlic3rWritesThem) {
    for (const char* id : {"0", "1"}) {
        const std::string text =
            amf("<metadata type=\"cad\">Slic3r 1.3.0</metadata>" + amf_object("0") + amf_object("1") +
                constellation(id, instance("0", "<deltax>9</deltax>") + instance("1", "<deltax>5</deltax>")));
        const MeshFile file = read(text);
        ASSERT_EQ(file.instances.size(), 2U) << "objectid means an object first";
        EXPECT_EQ(file.instances[0].object, 0U);
        EXPECT_EQ(file.instances[0].placement.offset, (std::array<double, 3>{9, 0, 0}));
        EXPECT_EQ(file.instances[1].object, 1U);
        EXPECT_EQ(file.instances[1].placement.offset, (std::array<double, 3>{5, 0, 0}));
        const std::string said = fmt::format("line 19: constellation '{}': an object has the same id", id);
        ASSERT_EQ(file.warnings.size(), 1U);
        EXPECT_TRUE(says(file.warnings[0], said));
        EXPECT_TRUE(says(error_of(text, ErrorKind::defect, {.strict = true}), said));
    }
}

TEST(Amf, TwoObjectsOrTwoConstellationsOfOneIdAreRefused) {
    EXPECT_EQ(error_of(amf(amf_object("0") + amf_object("0"))),
              "x: line 11: object '0': the id is there for the second time");
    EXPECT_EQ(error_of(amf(amf_object("0") + constellation("1", instance("0")) +
                           constellation("1", instance("0")))),
              "x: line 12: constellation '1': the id is there for the second time");
}

// They would be walked once for each of 65,536 instances.
TEST(Amf, OfManyEmptyInstancesEndsSoon) {
    LAMELLA_SKIP_IF_SLOWED();
    constexpr int doublings = 16;
    std::string empty;
    for (int i = 0; i < 50'000; ++i)
        empty += instance("e");
    std::string text =
        amf_object("0") + "<object id=\"e\"><mesh/></object>" + constellation("c0", instance("0") + empty);
    for (int i = 1; i <= doublings; ++i) {
        const std::string inner = instance(fmt::format("c{}", i - 1));
        text += constellation(fmt::format("c{}", i), inner + inner);
    }
    EXPECT_EQ(read(amf(text)).instances.size(), std::size_t{1} << doublings);
}

TEST(Amf, InstancesAreCountedBeforeMemoryIsTaken) {
    std::string text = amf_object("0") + constellation("c0", instance("0") + instance("0"));
    for (int i = 1; i < 16; ++i) {
        const std::string inner = instance(fmt::format("c{}", i - 1));
        text += constellation(fmt::format("c{}", i), inner + inner);
    }
    EXPECT_TRUE(says(error_of(amf(text), ErrorKind::limit, {.max_memory = 50'000'000}),
                     "65536 meshes that are put on the plate"));
}

TEST(Amf, AnObjectOfSupportsOnlyStopsNoStrictCaller) {
    const std::string support = replaced(amf_object("1"), "<volume", "<volume type=\"support\"");
    const MeshFile file = read(amf(amf_object("0") + support), {.strict = true});
    EXPECT_EQ(file.objects.size(), 1U);
    EXPECT_EQ(file.warnings.size(), 1U);
    EXPECT_THROW(
        static_cast<void>(read(amf(amf_object("0") + "<object id=\"1\"><mesh/></object>"), {.strict = true})),
        Error);
}

TEST(Amf, ZippedFilesAreReadToo) {
    const std::string text = amf(amf_object("0"));
    EXPECT_EQ(read(zip_bytes({{.name = "part.amf", .content = text}}), {.strict = true}).format, "amf");
    EXPECT_EQ(read(zip_bytes({{.name = "a/b.AMF", .content = text}, {.name = "readme", .content = "?"}}),
                   {.strict = true})
                  .stored_triangles,
              4U);
    EXPECT_EQ(read(zip_bytes({{.name = "anything", .content = text}}), {.strict = true}).stored_triangles,
              4U);
    const std::string two =
        zip_bytes({{.name = "a.amf", .content = text}, {.name = "b.amf", .content = text}});
    EXPECT_TRUE(says(read(two).warnings.at(0), "holds 2 AMF files; took the first, 'a.amf'"));
    EXPECT_TRUE(says(error_of(zip_bytes({{.name = "a.amf", .content = "<amf>"}})),
                     "x, part 'a.amf', line 1: the XML is broken"));
    EXPECT_TRUE(says(error_of(zip_bytes({{.name = "a.amf", .content = std::string(5'000'000, ' ') + text}}),
                              ErrorKind::limit, {.max_memory = 1'000'000}),
                     "`max_memory`"));
}

TEST(Amf, EmptyFilesHoldNothingToSlice) {
    EXPECT_TRUE(says(error_of("<amf/>"), "holds nothing to slice"));
    EXPECT_TRUE(says(error_of(replaced(amf(amf_object("0")), "<volume>", "<volume type=\"support\">")),
                     "holds nothing to slice: its only body is no material: 1 support; `include` support"));
    EXPECT_TRUE(says(error_of(amf("<object id=\"1\"><mesh><vertices/><volume/></mesh></object>")),
                     "holds nothing to slice"));
    EXPECT_TRUE(
        says(error_of(amf(amf_object("0") + constellation("1", instance("0", "<printable>0</printable>")))),
             "no instance leads to an object"));
}

TEST(Amf, ConstellationsThatContainThemselvesAreRefused) {
    EXPECT_TRUE(says(error_of(amf(amf_object("0") + constellation("1", instance("1")))),
                     "constellation '1': contains itself"));
    EXPECT_TRUE(says(error_of(amf(constellation("1", instance("2")) + constellation("2", instance("1")))),
                     "each constellation is a part of another"));
}

TEST(Amf, ABillionLaughsAreCountedAndNotMade) {
    std::string text = amf_object("0");
    for (int i = 1; i < 60; ++i)
        text += constellation(std::to_string(i),
                              instance(std::to_string(i - 1)) + instance(std::to_string(i - 1)));
    EXPECT_TRUE(says(error_of(amf(text), ErrorKind::limit), "puts 576460752303423488 meshes on the plate"));
    const std::string entities =
        "<!DOCTYPE amf [<!ENTITY a 'ha'><!ENTITY b '&a;&a;'>]>" + amf(amf_object("0"));
    EXPECT_NE(error_of(replaced(entities, "<?xml version=\"1.0\" encoding=\"utf-8\"?>", "")), "");
}

TEST(Amf, SurvivesMutations) {
    std::mt19937 random(20'24);
    const std::string seed =
        amf(amf_object("0") + amf_object("2") +
                constellation("1", instance("0", "<rx>30</rx><scale>2</scale>") + instance("2")),
            "unit=\"inch\"");
    constexpr std::string_view words[] = {"<vertex>",
                                          "</vertices>",
                                          "<triangle>",
                                          "</volume>",
                                          "<!--",
                                          "-->",
                                          "]]>",
                                          "\"",
                                          "&#49;",
                                          "nan",
                                          "1e400",
                                          "-1",
                                          "4294967296",
                                          "<instance objectid=\"1\"/>",
                                          "<volume>",
                                          "\xff",
                                          "<metadata type=\"name\">"};
    std::size_t read_anyway = 0;
    for (int round = 0; round < 8000; ++round)
        read_anyway += survive(mutated(seed, random, words)).has_value() ? 1 : 0;
    EXPECT_GT(read_anyway, 50U) << "the mutations are so wild that they test nothing";
}

TEST(AmfSamples, AreRead) {
    const std::filesystem::path folder = std::filesystem::path(LAMELLA_SHARED) / "formats/samples/amf-assimp";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no samples in " << LAMELLA_SHARED;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        const MeshFile file = read_mesh(entry.path().string(), {.strict = true});
        EXPECT_GT(volume(file.mesh()), 0) << entry.path();
    }
    EXPECT_EQ(read_mesh((folder / "test9.amf").string()).instances.size(), 12U);
    EXPECT_NEAR(volume(read_mesh((folder / "test_with_mat.amf").string()).mesh()), 25.4 * 25.4 * 25.4 / 3,
                1e-9);
}

} // namespace
} // namespace lamella::package_test::amf_cases
