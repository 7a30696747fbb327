#include "read/mesh_readers.hpp"
#include "read/package_checks.hpp"

#include <filesystem>

namespace lamella::package_test {
namespace {

using zip_test::zip_bytes;

std::string constellation(std::string_view id, std::string_view instances) {
    return fmt::format("<constellation id=\"{}\">{}</constellation>\n", id, instances);
}

std::string instance(std::string_view id, std::string_view numbers = "") {
    return fmt::format("<instance objectid=\"{}\">{}</instance>", id, numbers);
}

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
                                   {"micrometer", 0.001}}) {
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

TEST(Amf, VolumesOfAnObjectAreOneMeshAndSupportsAreLeftOut) {
    const std::string two = replaced(amf_object("0"), "</volume>",
                                     "</volume><volume materialid=\"2\"><metadata type=\"name\">x</metadata>"
                                     "<triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle></volume>");
    const MeshFile file = read(amf(two));
    EXPECT_EQ(file.objects.size(), 1U);
    EXPECT_EQ(file.stored_triangles, 5U);
    EXPECT_TRUE(file.warnings.empty());
    const std::string support = replaced(two, "materialid=\"2\"", "type=\"support\"");
    const MeshFile without = read(amf(support), {.strict = true});
    EXPECT_EQ(without.stored_triangles, 4U);
    EXPECT_EQ(
        without.warnings.at(0),
        "1 body was left out as no material: 1 support (\"x\"); `include` support to read it as a solid");
    const MeshFile with = read(amf(support), {.include = {MeshRole::support}});
    EXPECT_EQ(with.stored_triangles, 5U);
    EXPECT_TRUE(with.warnings.empty());
    ASSERT_EQ(with.instances.size(), 2U);
    EXPECT_FALSE(with.instances[0].support);
    EXPECT_TRUE(with.instances[1].support);
}

TEST(Amf, VolumesThatSlic3rMarksAsNoMaterialAreNone) {
    const auto marked = [](std::string_view type, std::string_view value, bool behind = false) {
        const std::string mark = fmt::format("<metadata type=\"{}\">{}</metadata>", type, value);
        const std::string triangle = "<triangle><v1>0</v1><v2>1</v2><v3>2</v3></triangle>";
        return amf(
            replaced(amf_object("0"), "</volume>",
                     "</volume><volume>" + (behind ? triangle + mark : mark + triangle) + "</volume>"));
    };
    for (const bool behind : {false, true}) {
        for (const auto& [type, value, role] :
             {std::tuple("slic3r.modifier", "1", MeshRole::modifier),
              {"slic3r.volume_type", "ParameterModifier", MeshRole::modifier},
              {"slic3r.volume_type", "SupportBlocker", MeshRole::support_blocker},
              {"slic3r.volume_type", "SupportEnforcer", MeshRole::support_enforcer}}) {
            const MeshFile file = read(marked(type, value, behind), {.strict = true});
            EXPECT_EQ(file.stored_triangles, 4U);
            EXPECT_TRUE(says(file.warnings.at(0), row_of(role).name));
            ASSERT_EQ(file.bodies.size(), 2U);
            EXPECT_EQ(file.bodies[1].role, role);
            EXPECT_EQ(read(marked(type, value, behind), {.include = {role}}).stored_triangles, 5U);
        }
        const MeshFile negative = read(marked("slic3r.volume_type", "NegativeVolume", behind));
        ASSERT_EQ(negative.instances.size(), 2U);
        EXPECT_FALSE(negative.instances[0].negative);
        EXPECT_TRUE(negative.instances[1].negative);
        EXPECT_EQ(negative.instances[0].body, negative.instances[1].body);
        EXPECT_TRUE(negative.warnings.empty());
        EXPECT_EQ(read(marked("slic3r.volume_type", "ModelPart", behind)).stored_triangles, 5U);
    }
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

TEST(Amf, ANumberHoldsNoElements) {
    const std::string odd = replaced(amf_object("0"), "<x>1</x>", "<x>1<b>7</b>0</x>");
    const std::string error = error_of(amf(odd));
    EXPECT_TRUE(says(error, "found <b> in <x>, expected a number")) << error;
}

TEST(Amf, CurvesAreFlatAndSaidToBe) {
    const MeshFile file =
        read(amf(replaced(replaced(amf_object("0"), "</coordinates>",
                                   "</coordinates><normal><nx>0</nx><ny>0</ny><nz>1</nz></normal>"),
                          "</vertices>", "<edge><v1>0</v1><dx1>1</dx1><v2>1</v2></edge></vertices>")));
    EXPECT_EQ(file.stored_triangles, 4U);
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_TRUE(
        says(file.warnings[0], "line 3: edges and normals bend triangles; they were passed over, as all 5"));
}

TEST(Amf, ReadsMeshesThatAreNotWrittenPlainlyAllTheSame) {
    const std::string plain = amf(amf_object("0"));
    const IndexedMesh expected = *read(plain).objects[0].mesh.indexed();
    for (const std::string& text :
         {replaced(plain, "<z>", "<!-- z --><z>"),
          replaced(plain, "<coordinates>", "<color><r>1</r></color><coordinates>"),
          replaced(plain, "<x>1</x><y>0</y>", "<y>0</y><x>1.0e0</x>"), replaced(plain, "><", ">\n\t<"),
          replaced(plain, ">0<", "> 0\n<"), replaced(plain, ">1<", ">&#49;<"),
          replaced(plain, "<triangle>", "<triangle a='b'>"),
          replaced(plain, "</v3>", "</v3><color><r>1</r></color>"), replaced(plain, "\n", "\r\n"),
          replaced(plain, "</volume>", "<metadata type=\"a\">b</metadata></volume>"),
          std::string("\xEF\xBB\xBF").append(plain)}) {
        const MeshFile file = read(text);
        EXPECT_EQ(file.objects.at(0).mesh.indexed()->vertices, expected.vertices) << text;
        EXPECT_EQ(file.objects.at(0).mesh.indexed()->triangles, expected.triangles) << text;
    }
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

TEST(Amf, NamesTheLineOfWhatIsWrong) {
    const std::string good = amf(amf_object("0") + constellation("1", instance("0", "<rx>1</rx>")));
    EXPECT_EQ(error_of(good), "");
    const auto wrong = [&](std::string_view from, std::string_view to) {
        const std::string text = replaced(good, from, to);
        EXPECT_NE(text, good) << from;
        return error_of(text);
    };
    EXPECT_EQ(wrong("<x>1</x>", "<x>1,0</x>"),
              "x, line 4: found '1,0' in <x>, expected a number with a decimal point");
    for (const char* number : {"nan", "inf", "1e400", "1e39", "", "1 2"})
        EXPECT_TRUE(says(wrong("<x>1</x>", fmt::format("<x>{}</x>", number)), "in <x>, expected a number"))
            << number;
    EXPECT_TRUE(says(wrong("<x>1</x>", ""), "x, line 4: found a vertex without all of x, y and z"));
    EXPECT_TRUE(says(wrong("<x>1</x>", "<x>1</x><x>2</x>"), "found a second <x>"));
    EXPECT_TRUE(says(wrong("<v3>1</v3>", "<v3>4</v3>"),
                     "found v3 = 4, expected less than 4, the number of vertices before it"));
    EXPECT_TRUE(says(wrong("<v3>1</v3>", "<v3>4294967296</v3>"),
                     "found '4294967296' in <v3>, expected a whole number"));
    EXPECT_TRUE(says(wrong("<v3>1</v3>", "<v3>-1</v3>"), "found '-1' in <v3>, expected a whole number"));
    EXPECT_TRUE(says(wrong("<v3>1</v3>", ""), "found a triangle without all of v1, v2 and v3"));
    EXPECT_TRUE(says(wrong("objectid=\"0\"", "objectid=\"7\""),
                     "x: line 11: found objectid '7', but there is nothing of that id"));
    EXPECT_TRUE(says(wrong("objectid=\"0\"", ""), "found an element without objectid"));
    EXPECT_TRUE(says(wrong("</mesh>", "</mesh><mesh/>"), "found a second <mesh>"));
    EXPECT_TRUE(says(wrong("<rx>1</rx>", "<rx>one</rx>"), "found 'one' in <rx>, expected a number"));
}

TEST(Amf, EmptyFilesHoldNothingToSlice) {
    EXPECT_TRUE(says(error_of("<amf/>"), "holds nothing to slice"));
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

TEST(Amf, EveryPrefixIsRefused) {
    const std::string whole = amf(amf_object("0") + constellation("1", instance("0", "<rx>1</rx>")));
    for (std::size_t size = 1; size + 1 < whole.size(); ++size)
        EXPECT_FALSE(survive(whole.substr(0, size)).has_value()) << size;
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
} // namespace lamella::package_test
