#include "fixtures/package_checks.hpp"
#include "fixtures/three_mf_files.hpp"
#include "meshes/mesh_readers.hpp"

namespace lamella::package_test::three_mf_cases {
namespace {

TEST(ThreeMf, UnitsScaleMeshesAndTransforms) {
    for (const auto& [unit, mm] : {std::pair("micron", 0.001),
                                   {"millimeter", 1.0},
                                   {"centimeter", 10.0},
                                   {"inch", 25.4},
                                   {"foot", 304.8},
                                   {"meter", 1000.0}}) {
        const MeshFile file = read(package(
            model(object(1, box_mesh()), "<item objectid=\"1\" transform=\"1 0 0 0 1 0 0 0 1 2 0 -1\"/>",
                  fmt::format("unit=\"{}\"", unit))));
        EXPECT_EQ(file.unit_mm, mm);
        expect_box(file, {2 * mm, 0, -mm}, {3 * mm, 2 * mm, 2 * mm});
        EXPECT_EQ(file.objects[0].mesh.indexed()->vertices[7], (Point3{1, 2, 3})) << "in the file's own unit";
    }
    EXPECT_TRUE(says(in_model(error_of(package(model(object(1, box_mesh()), one_item, "unit=\"mile\"")))),
                     "found unit 'mile', expected micron"));
}

TEST(ThreeMf, TransformsMultiplyRowsFromTheLeftInnerFirst) {
    // Turned by 90 degrees about z, then moved; the component scales x before that.
    const MeshFile file = read(package(
        model(object(1, box_mesh()) + object(2, components({{1, "transform=\"2 0 0 0 1 0 0 0 1 0 0 5\""}})),
              "<item objectid=\"2\" transform=\"0 1 0 -1 0 0 0 0 1 10 0 0\"/>")));
    expect_box(file, {8, 0, 5}, {10, 2, 8});
    EXPECT_DOUBLE_EQ(volume(file.mesh()), 12);
}

TEST(ThreeMf, ItemsThatAreNotToBePrintedAreLeftOut) {
    const MeshFile file =
        read(package(model(object(1, box_mesh()), one_item + "<item objectid=\"1\" printable=\"0\"/>")));
    EXPECT_EQ(file.instances.size(), 1U);
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_TRUE(says(file.warnings[0], "1 item is marked in the build as not to be printed"));
    // Its object is not in the way of another one that is not in the build.
    const MeshFile two = read(package(model(object(1, box_mesh()) + object(2, box_mesh()),
                                            one_item + "<item objectid=\"2\" printable=\"0\"/>")));
    EXPECT_EQ(two.warnings.size(), 1U);
}

TEST(ThreeMf, RequiredExtensionsMustBeKnown) {
    const auto requiring = [](std::string_view attributes) {
        return package(model(object(1, box_mesh()), one_item, attributes));
    };
    EXPECT_EQ(error_of(requiring("requiredextensions=\"p\"")), "");
    EXPECT_EQ(error_of(requiring("requiredextensions=\" \"")), "");
    EXPECT_TRUE(says(in_model(error_of(requiring("requiredextensions=\"p nobody\""))),
                     "requires the extension 'nobody' without saying what that is"));
    EXPECT_TRUE(says(in_model(error_of(requiring("xmlns:y=\"https://y\" requiredextensions=\"y\""))),
                     "requires the extension 'y' (https://y), which is not known here"));
    const std::string lattice = replaced(model(object(1, box_mesh()), one_item,
                                               "xmlns:b=\"http://schemas.microsoft.com/3dmanufacturing/"
                                               "beamlattice/2017/02\" recommendedextensions=\"b\""),
                                         "</triangles>", "</triangles><b:beamlattice/>");
    EXPECT_TRUE(says(read(package(lattice)).warnings.at(0), "its beams were left out"));
    EXPECT_TRUE(says(in_model(error_of(package(replaced(lattice, "recommended", "required")))),
                     "found a beam lattice; those cannot be read"));
}

TEST(ThreeMf, AbsurdTransformsAreRefusedBeforeTheyOverflow) {
    const auto item = [](std::string_view transform) {
        return package(model(object(1, box_mesh()) +
                                 object(2, components({{1, fmt::format("transform=\"{}\"", transform)}})),
                             fmt::format("<item objectid=\"2\" transform=\"{}\"/>", transform)));
    };
    EXPECT_EQ(error_of(item("1e9 0 0 0 1e9 0 0 0 1e9 0 0 0")), "");
    EXPECT_TRUE(
        says(error_of(item("1e30 0 0 0 1e30 0 0 0 1e30 0 0 0")), "puts a mesh further away than 1e+38 mm"));
    EXPECT_TRUE(
        says(error_of(item("1e37 0 0 0 1e37 0 0 0 1e37 1e37 1e37 1e37")), "puts a mesh further away"));
    EXPECT_TRUE(says(error_of(item("1e-90 0 0 0 1e-90 0 0 0 1e-90 0 0 0")), "flattens"));
}

} // namespace
} // namespace lamella::package_test::three_mf_cases
