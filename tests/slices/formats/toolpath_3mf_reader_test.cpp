#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/package_checks.hpp"
#include "slices/formats/toolpath_3mf_format.hpp"

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace lamella::toolpath_3mf_cases {
namespace {

using package_test::replaced;

/// A job of layers, one above the other, listed under these names: a.xml has these segments, b.xml none. Both
/// parts have one name.
std::string job(const std::vector<std::string>& layers, const std::string& segments = "",
                const std::string& speed = "800") {
    std::string resource =
        "<t:toolpathresource id=\"1\" unitfactor=\"0.001\"><t:toolpathprofiles>"
        "<t:toolpathprofile uuid=\"fill\" name=\"fill\" laserspeed=\"" +
        speed +
        "\" laserindex=\"0\"/>"
        "<t:toolpathprofile uuid=\"other\" name=\"other\" laserspeed=\"900\" laserindex=\"1\"/>"
        "</t:toolpathprofiles><t:toolpathlayers>\n";
    for (std::size_t i = 0; i < layers.size(); ++i)
        resource += fmt::format("<t:toolpathlayer ztop=\"{}\" path=\"{}\"/>\n", i + 1, layers[i]);
    const std::string layer = fmt::format("<layer xmlns=\"{}\"/>", toolpath_3mf::space);
    const std::string full = fmt::format(
        "<layer xmlns=\"{}\"><parts><part id=\"1\" uuid=\"first\"/><part id=\"2\" uuid=\"second\"/></parts>"
        "<profiles><profile id=\"1\" uuid=\"fill\"/><profile id=\"2\" uuid=\"other\"/></profiles>"
        "<segments>{}</segments></layer>",
        toolpath_3mf::space, segments);
    return zip_test::zip_bytes(
        {{.name = "_rels/.rels", .content = package_test::relationships({"/3D/3dmodel.model"})},
         {.name = "3D/3dmodel.model",
          .content = package_test::model(
              resource + "</t:toolpathlayers></t:toolpathresource>" +
                  package_test::object(2, "", "name=\"AA1\"") + package_test::object(3, "", "name=\"AA1\""),
              "<item objectid=\"2\" p:UUID=\"first\"/><item objectid=\"3\" "
              "p:UUID=\"second\"/>",
              fmt::format("xmlns:t=\"{}\" t:toolpathid=\"1\"", toolpath_3mf::space))},
         {.name = "3D/_rels/3dmodel.model.rels",
          .content = replaced(package_test::relationships({"/L/a.xml", "/L/b.xml"}),
                              "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel",
                              toolpath_3mf::layer_type)},
         {.name = "L/a.xml", .content = full},
         {.name = "L/b.xml", .content = layer}});
}

LayerFile read(const std::string& bytes) {
    return read_layers(std::as_bytes(std::span(bytes)), "test.3mf");
}

TEST(ReadToolpath3mf, EachLayerHasAPartOfItsOwnHoweverThatIsSpelt) {
    EXPECT_EQ(read(job({"/L/a.xml", "/L/b.xml"})).in_memory().at(0).layers.size(), 2U);
    for (const std::string again : {"/L/a.xml", "/L/./a.xml", "../L/a.xml", "/L/%61.xml", "/l/A.xml"})
        try {
            static_cast<void>(read(job({"/L/a.xml", again})));
            ADD_FAILURE() << "no error: " << again;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::input);
            EXPECT_TRUE(package_test::says(error.what(),
                                           fmt::format("line 5: found the layer '{}' a second time", again)));
        }
}

std::string hatch(int profile, int part, const char* more = "") {
    return fmt::format("<segment type=\"hatch\" profileid=\"{}\" partid=\"{}\" {}>"
                       "<hatch x1=\"0\" y1=\"0\" x2=\"9\" y2=\"9\"/></segment>",
                       profile, part, more);
}

TEST(ReadToolpath3mf, SaysWhichLayersLoseTheOrderOfExecution) {
    EXPECT_TRUE(read(job({"/L/a.xml"}, hatch(1, 1) + hatch(1, 1))).warnings.empty());
    for (const std::string& segments : {hatch(1, 1) + hatch(2, 1) + hatch(1, 1), hatch(1, 2) + hatch(1, 1)}) {
        const std::vector<std::string> warnings = read(job({"/L/a.xml", "/L/b.xml"}, segments)).warnings;
        EXPECT_TRUE(std::any_of(warnings.begin(), warnings.end(), [](const std::string& warning) {
            return warning.starts_with(
                "vectors of 1 layer, the lowest at z = 0.001 mm, are executed in another");
        }));
    }
}

TEST(ReadToolpath3mf, SaysWhichSegmentsAreForAnotherLaser) {
    EXPECT_EQ(read(job({"/L/a.xml"}, hatch(1, 1) + hatch(1, 1, "laserindex=\"2\"") + hatch(2, 1))).warnings,
              (std::vector<std::string>{"2 segments are for another laser than the first; which one was left "
                                        "out (first at test.3mf, part 'L/a.xml', line 1)"}));
}

TEST(ReadToolpath3mf, RefusesNegativeSpeeds) {
    const std::string error = test::error_of(
        ErrorKind::input, [] { static_cast<void>(read(job({"/L/a.xml"}, hatch(1, 1), "-800"))); });
    EXPECT_NE(error.find("line 3: found a profile with a speed below 0, expected 0 or more"),
              std::string::npos)
        << error;
}

TEST(ReadToolpath3mf, PartsOfOneNameGetNamesOfTheirOwn) {
    const LayerFile file = read(job({"/L/a.xml"}, hatch(1, 1) + hatch(1, 2)));
    ASSERT_EQ(file.parts.size(), 2U);
    EXPECT_EQ(file.parts[0].label, "AA1 core hatch");
    EXPECT_EQ(file.parts[1].label, "AA1 2 core hatch");
    EXPECT_EQ(file.warnings, (std::vector<std::string>{"1 part has the name of another one; a number was put "
                                                       "behind it, the first is now 'AA1 2'"}));
}

} // namespace
} // namespace lamella::toolpath_3mf_cases
