#include "fixtures/package_checks.hpp"
#include "fixtures/three_mf_files.hpp"
#include "meshes/mesh_readers.hpp"

#include <algorithm>
#include <vector>

namespace lamella::package_test::three_mf_cases {
namespace {

TEST(ThreeMf, ReadsMeshesThatAreNotWrittenPlainlyAllTheSame) {
    const std::string plain = model(object(1, box_mesh()), one_item);
    const IndexedMesh expected = *read(package(plain)).objects[0].mesh.indexed();
    const std::vector<std::string> same = {
        replaced(plain, "<vertex ", "<!-- v --><vertex "),
        replaced(plain, "<vertex x=", "<vertex\n\ty='7' x="),
        replaced(replaced(plain, "<vertex x=\"0\"", "<vertex x=\"-0.0e5\""), "x=\"1\"", "x=\" 1.0 \""),
        replaced(plain, "\"/>\n", "\"></vertex>\n"),
        replaced(plain, "x=\"1\"", "x=\"&#49;\""),
        replaced(plain, "<triangle ", "<triangle p1='0' pid=\"4\" "),
        replaced(plain, "<triangle ", "<triangle p:x=\"1\" paint_color=\"0C\" "),
        replaced(plain, "<triangle ", "<triangle>\n<p:extra/></triangle><triangle "),
        replaced(plain, "\n", "\r\n"),
        replaced(plain, "\n", "\r"),
    };
    for (std::size_t i = 0; i < same.size(); ++i) {
        std::string text = same[i];
        if (i == 1)
            text = replaced(replaced(text, "y='7' ", ""), "x=", "\n x=");
        if (i == 3)
            text =
                replaced(replaced(plain, "\"/>\n<v", "\"></vertex>\n<v"), "\"/>\n</v", "\"></vertex>\n</v");
        if (i == 7)
            text = replaced(plain, "</triangles>", "<p:extra/></triangles>");
        const MeshFile file = read(package(text));
        ASSERT_EQ(file.objects.size(), 1U) << i;
        EXPECT_EQ(file.objects[0].mesh.indexed()->vertices, expected.vertices) << i;
        EXPECT_EQ(file.objects[0].mesh.indexed()->triangles, expected.triangles) << i;
    }
}

TEST(ThreeMf, FilesOfTheBetaAreReadWithAWarning) {
    const std::string today =
        model(object(1, box_mesh()) + object(2, components({{1, "transform=\"1 0 0 0 1 0 0 0 1 9 0 0\""}})),
              one_item + "<item objectid=\"2\"/>");
    const std::string beta = replaced(today, "core/2015/02", "2013/01");
    for (const std::string& text : {beta, replaced(beta, "<vertex ", "<vertex a=\"b\" ")}) {
        const MeshFile file = read(package(text));
        const MeshFile same = read(package(today));
        ASSERT_EQ(file.instances.size(), 2U);
        EXPECT_EQ(file.instances[1].placement.offset, same.instances[1].placement.offset);
        EXPECT_EQ(file.objects[0].mesh.indexed()->vertices, same.objects[0].mesh.indexed()->vertices);
        EXPECT_EQ(file.objects[0].mesh.indexed()->triangles, same.objects[0].mesh.indexed()->triangles);
        ASSERT_EQ(file.warnings.size(), 1U);
        EXPECT_TRUE(says(file.warnings[0], "line 2: found a file of the beta of 3MF"));
    }
    EXPECT_TRUE(says(error_of(package(beta), ErrorKind::defect, {.strict = true}), "the beta of 3MF"));
    EXPECT_TRUE(
        says(error_of(package(replaced(beta, "v1=\"0\"", "v1=\"8\""))), "found v1 = 8, expected less"));
    // Of a file of today's, elements of the beta are foreign ones.
    EXPECT_EQ(
        read(package(replaced(today, "</vertices>",
                              "<b:vertex xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/2013/01\" "
                              "x=\"a\"/></vertices>")))
            .objects[0]
            .mesh.indexed()
            ->vertices.size(),
        8U);
}

TEST(ThreeMf, NamespacesCountAndNotPrefixes) {
    const std::string plain = model(object(1, box_mesh()), one_item);
    std::string prefixed = replaced(replaced(plain, "</", "</c:"), "<c:", "<c:");
    for (const char* name : {"model", "resources", "build", "object", "mesh", "vertices", "vertex ",
                             "triangles", "triangle ", "item"})
        prefixed = replaced(prefixed, fmt::format("<{}", name), fmt::format("<c:{}", name));
    prefixed = replaced(prefixed, "<c:triangles", "<c:triangles");
    prefixed = replaced(prefixed, "xmlns=", "xmlns:c=");
    EXPECT_EQ(read(package(prefixed)).objects[0].mesh.indexed()->vertices,
              read(package(plain)).objects[0].mesh.indexed()->vertices);
    EXPECT_TRUE(says(in_model(error_of(package(replaced(plain, "core/2015/02", "core/1999")))),
                     "expected <model> of 'http://schemas"));
    // Vertices of another namespace are none.
    const MeshFile file = read(package(replaced(plain, "</vertices>", "<p:vertex x=\"a\"/></vertices>")));
    EXPECT_EQ(file.objects[0].mesh.indexed()->vertices.size(), 8U);
}

TEST(ThreeMf, TypesOfObjectsDecideWhatIsRead) {
    const auto with_type = [](std::string_view type) {
        return package(model(object(1, box_mesh()) + object(2, box_mesh(), fmt::format("type=\"{}\"", type)),
                             one_item + "<item objectid=\"2\"/>"));
    };
    EXPECT_EQ(read(with_type("model")).instances.size(), 2U);
    EXPECT_EQ(read(with_type("solidsupport")).instances.size(), 2U);
    for (const char* type : {"support", "surface"}) {
        const MeshFile file = read(with_type(type), {.strict = true});
        EXPECT_EQ(file.instances.size(), 1U);
        ASSERT_EQ(file.warnings.size(), 1U);
        EXPECT_EQ(file.warnings[0],
                  fmt::format("1 body was left out as no material: 1 {0}; `include` {0} to read "
                              "it as a solid",
                              type));
        ASSERT_EQ(file.bodies.size(), 2U);
        EXPECT_TRUE(std::any_of(file.bodies.begin(), file.bodies.end(), [&](const MeshBody& body) {
            return row_of(body.role).name == type && body.left_out && body.triangles == 12;
        }));
    }
    const MeshFile supports = read(with_type("support"), {.include = {MeshRole::support}});
    ASSERT_EQ(supports.instances.size(), 2U);
    EXPECT_FALSE(supports.instances[0].support);
    EXPECT_TRUE(supports.instances[1].support);
    EXPECT_TRUE(supports.warnings.empty());
    for (const MeshRole role : {MeshRole::surface, MeshRole::other}) {
        const MeshFile included = read(with_type(row_of(role).word), {.include = {role}});
        ASSERT_EQ(included.instances.size(), 2U);
        EXPECT_FALSE(included.instances[1].support);
        EXPECT_TRUE(included.warnings.empty());
    }
    EXPECT_EQ(read(with_type("surface"), {.include = {MeshRole::support}}).instances.size(), 1U);
    EXPECT_TRUE(
        says(in_model(error_of(with_type("other"))), "whose type 'other' says that it is not to be made"));
    EXPECT_TRUE(says(in_model(error_of(with_type("thing"))), "found an object of type 'thing'"));
    EXPECT_TRUE(says(error_of(package(model(object(1, box_mesh(), "type=\"support\""), one_item))),
                     "holds nothing to slice"));
}

TEST(ThreeMf, SettingsOfCuraSayWhatIsNoMaterial) {
    const auto with = [](std::string_view settings) {
        return package(model(object(1, box_mesh()) + object(2, std::string(settings) + box_mesh()),
                             one_item + "<item objectid=\"2\"/>",
                             "xmlns:cura=\"http://software.ultimaker.com/xml/cura/3mf/2015/10\""));
    };
    for (const auto& [setting, role] : {std::pair("anti_overhang_mesh", MeshRole::support_blocker),
                                        {"support_mesh", MeshRole::support},
                                        {"infill_mesh", MeshRole::modifier},
                                        {"cutting_mesh", MeshRole::modifier}})
        for (const char* form :
             {"<metadatagroup><metadata name=\"cura:{}\">True</metadata></metadatagroup>",
              "<cura:settings><cura:setting key=\"{}\"> true </cura:setting></cura:settings>"}) {
            const MeshFile file = read(with(fmt::format(fmt::runtime(form), setting)));
            EXPECT_EQ(file.instances.size(), 1U) << setting;
            EXPECT_TRUE(says(file.warnings.at(0), row_of(role).name));
            EXPECT_EQ(read(with(replaced(fmt::format(fmt::runtime(form), setting), "rue", "alse")))
                          .instances.size(),
                      2U);
        }
}

TEST(ThreeMf, MeshesOfLowResolutionNeverStandInForSlices) {
    const std::string coarse =
        model(object(1, box_mesh()) +
                  object(2, box_mesh(),
                         "s:meshresolution=\"lowres\" s:slicestackid=\"1\" "
                         "xmlns:s=\"http://schemas.microsoft.com/3dmanufacturing/slice/2015/07\""),
              one_item + "<item objectid=\"2\"/>");
    EXPECT_TRUE(says(error_of(package(coarse)),
                     "object 2: its mesh is of low resolution and only stands in for its "
                     "slices; slices are layers already"));
    EXPECT_EQ(read(package(replaced(coarse, "lowres", "fullres"))).instances.size(), 2U);
    EXPECT_EQ(read(package(replaced(coarse, "<item objectid=\"2\"/>", ""))).instances.size(), 1U);
}

TEST(ThreeMf, FilesOfTheBetaMayCountFromZero) {
    const std::string zero = model(object(0, box_mesh()), "<item objectid=\"0\"/>");
    EXPECT_TRUE(says(in_model(error_of(package(zero))), "found id 0, expected 1 to"));
    const MeshFile file = read(package(replaced(zero, "core/2015/02", "2013/01")));
    EXPECT_EQ(file.stored_triangles, 12U);
    EXPECT_TRUE(says(file.warnings.at(0), "the beta of 3MF"));
}

TEST(ThreeMf, VerticesComeBeforeTrianglesHoweverTheseAreWritten) {
    std::string mesh = box_mesh();
    const std::size_t vertices = mesh.find("<vertices>");
    const std::size_t triangles = mesh.find("<triangles>");
    const std::size_t end = mesh.find("</mesh>");
    mesh = "<mesh>" + mesh.substr(triangles, end - triangles) + mesh.substr(vertices, triangles - vertices) +
           "</mesh>";
    for (const std::string& written : {mesh, replaced(mesh, "v1=", "v1 =")}) {
        const std::string error = error_of(package(model(object(1, written), one_item)));
        EXPECT_TRUE(says(error, "found <triangles> before <vertices>, expected vertices first")) << error;
    }
}

TEST(ThreeMf, BytesThatAreNoTextAreRefusedAlsoInPlainElements) {
    const auto with = [](const std::string& value) {
        return error_of(package(model(
            object(1, replaced(box_mesh(), "<triangle ", "<triangle x=\"" + value + "\" ")), one_item)));
    };
    EXPECT_EQ(with("y"), "");
    EXPECT_TRUE(says(with("\xff"), "not well-formed")) << with("\xff");
}

TEST(ThreeMf, NamesTheLineOfWhatIsWrong) {
    const std::string good = model(object(1, box_mesh()), one_item);
    const auto wrong = [&](std::string_view from, std::string_view to) {
        const std::string text = replaced(good, from, to);
        EXPECT_NE(text, good) << from;
        return in_model(error_of(package(text)));
    };
    EXPECT_EQ(wrong("<vertex x=\"1\" y=\"2\" z=\"0\"/>", "<vertex x=\"1\" y=\"2,0\" z=\"0\"/>"),
              "x, part '3D/3dmodel.model', line 7: found y = '2,0', expected a number within 1e+38");
    for (const char* number : {"nan", "inf", "1e400", "1e39", "0x10", "1 2", "", "1.#IND", "--1", "1e"})
        EXPECT_TRUE(says(wrong("x=\"1\" y=\"2\"", fmt::format("x=\"{}\" y=\"2\"", number)),
                         fmt::format("found x = '{}', expected a number", number)));
    EXPECT_TRUE(says(wrong("<vertex x=\"1\" ", "<vertex "), "found an element without x"));
    EXPECT_TRUE(
        says(wrong("v3=\"6\"", "v3=\"8\""), "found v3 = 8, expected less than 8, the number of vertices"));
    EXPECT_TRUE(says(wrong("v3=\"6\"", "v3=\"4294967295\""), "found v3 = 4294967295, expected less than 8"));
    EXPECT_TRUE(
        says(wrong("v3=\"6\"", "v3=\"4294967296\""), "found v3 = '4294967296', expected a whole number"));
    EXPECT_TRUE(says(wrong("v3=\"6\"", "v3=\"-1\""), "found v3 = '-1', expected a whole number"));
    EXPECT_TRUE(
        says(wrong("objectid=\"1\"", "objectid=\"2\""), "found objectid 2, but there is no such object"));
    EXPECT_TRUE(says(wrong("objectid=\"1\"", ""), "found an element without objectid"));
    EXPECT_TRUE(says(wrong("object id=\"1\"", "object id=\"0\""), "found id 0, expected 1 to 2147483647"));
    EXPECT_TRUE(says(wrong("object id=\"1\"", "object id=\"2147483648\""), "found id 2147483648, expected"));
    EXPECT_TRUE(says(wrong("</resources>", object(1, box_mesh()) + "</resources>"),
                     "found id 1 for the second time"));
    EXPECT_TRUE(says(wrong("</mesh>", "</mesh>" + box_mesh()), "found a second content of object 1"));
    EXPECT_TRUE(says(wrong("</vertices>", "</vertices><vertices/>"), "found a second <vertices>"));
    EXPECT_TRUE(says(wrong("<build>", "<build/><build>"), "found a second <build>"));
    EXPECT_TRUE(says(wrong("<resources>", "<resources/><resources>"), "found a second <resources>"));
    EXPECT_TRUE(says(wrong("<model", "<!DOCTYPE model><model"), "found a document type"));
    EXPECT_TRUE(says(wrong("UTF-8", "ISO-8859-1"), "expected UTF-8"));
    EXPECT_TRUE(says(wrong("<item objectid", "<item transform=\"1 0 0 0 1 0 0 0 1 0 0\" objectid"),
                     "expected 12 numbers"));
    EXPECT_TRUE(says(wrong("<item objectid", "<item transform=\"1 0 0 0 1 0 0 0 1 0 0 0 0\" objectid"),
                     "and no more"));
    EXPECT_TRUE(says(wrong("<item objectid", "<item transform=\"1 0 0 0 1 0 0 0 0 0 0 0\" objectid"),
                     "which flattens"));
    EXPECT_TRUE(says(wrong("<item objectid", "<item transform=\"1 0 0 0 1 0 0 0 nan 0 0 0\" objectid"),
                     "expected 12 numbers"));
    EXPECT_TRUE(says(wrong("<item objectid", "<item transform=\"1 0 0 0 1 0 0 0 1x0 0 0\" objectid"),
                     "expected 12 numbers"));
    EXPECT_TRUE(says(error_of(package(model(object(1, ""), one_item))), "neither a mesh nor components"));
    EXPECT_TRUE(says(error_of(package(model(object(1, box_mesh()), ""))), "its build is empty"));
    EXPECT_TRUE(
        says(error_of(package(replaced(good, "<build>" + one_item + "</build>", ""))), "found no <build>"));
    EXPECT_TRUE(says(error_of(package(model(object(1, "<mesh><vertices/><triangles/></mesh>"), one_item))),
                     "holds nothing to slice"));
}

TEST(ThreeMf, EntitiesAreNotExpanded) {
    const std::string text = replaced(model(object(1, box_mesh(), "name=\"&b;\""), one_item), "<model",
                                      "<!DOCTYPE model [<!ENTITY a 'ha'><!ENTITY b '&a;&a;&a;'>]><model");
    EXPECT_TRUE(says(in_model(error_of(package(text))), "found a document type"));
}

TEST(ThreeMf, EveryPrefixOfAModelIsRefused) {
    const std::string whole = model(object(1, box_mesh()), one_item);
    for (std::size_t size = 0; size + 2 < whole.size(); ++size)
        EXPECT_FALSE(survive(package(whole.substr(0, size), {}, false)).has_value()) << size;
}

} // namespace
} // namespace lamella::package_test::three_mf_cases
