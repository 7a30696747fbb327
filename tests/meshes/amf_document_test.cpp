#include "fixtures/package_checks.hpp"
#include "meshes/amf_files.hpp"
#include "meshes/mesh_readers.hpp"

namespace lamella::package_test::amf_cases {
namespace {

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

TEST(Amf, EveryPrefixIsRefused) {
    const std::string whole = amf(amf_object("0") + constellation("1", instance("0", "<rx>1</rx>")));
    for (std::size_t size = 1; size + 1 < whole.size(); ++size)
        EXPECT_FALSE(survive(whole.substr(0, size)).has_value()) << size;
}

} // namespace
} // namespace lamella::package_test::amf_cases
