#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/compare_files.hpp"
#include "lamella/jobs/verify.hpp"
#include "lamella/slices/layer_writer.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/meshes.hpp"
#include "jobs/image_check.hpp"
#include "jobs/moved_cuts.hpp"

#include <gtest/gtest.h>

#include <span>
#include <string>
#include <vector>

namespace lamella::image_check_cases {
namespace {

constexpr ResinPrinter printer{.name = "Tester",
                               .pixels = {400, 300},
                               .display_mm = {20, 15},
                               .mirror_x = true,
                               .bottom_layers = 2,
                               .transition_layers = 1};

/// A wedge without symmetry, whose sections become smaller.
Mesh wedge() {
    const std::vector<Point3> corners{{0, 0, 5}, {9, 1, 5}, {1, 5, 5}, {2, 1, 7}};
    const std::vector<std::array<std::uint32_t, 3>> triangles{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
    return Mesh(IndexedMesh{corners, triangles});
}

/// A goo file of the mesh, with these options of images.
std::string goo_of(const Mesh& mesh, const ImageOptions& image) {
    LayerStack planes;
    for (std::uint64_t i = 0; i < 20; ++i) {
        const double bottom = 5 + 0.1 * static_cast<double>(i);
        planes.push_back({.index = i, .z = bottom + 0.05, .bottom = bottom, .top = bottom + 0.1});
    }
    VerifyOptions options;
    options.mesh = mesh;
    const LayerStack layers = sections_of(options, plan_of(planes, PlaneRule::section_above, 0), {});
    std::string bytes;
    LayerFileInfo info{.box = part_box(layers), .layers = layers.size(), .bottom = 5};
    info.memory = &bytes;
    write_layers("job", layer_format("goo", ""), std::vector<Plane>(layers.begin(), layers.end()), info,
                 {.image = image, .printer = &printer});
    return bytes;
}

LayerFile read(const std::string& bytes) {
    return read_layers(std::as_bytes(std::span(bytes)), "job", {}, {.threads = 2});
}

Verification verified(const LayerFile& file, const Mesh& mesh) {
    VerifyOptions options{.rounding = file.rounding};
    options.mesh = mesh;
    return verify(file, options, {.threads = 2});
}

TEST(ImageCheck, AgreesWithTheMeshThatWasSliced) {
    const Verification found = verified(read(goo_of(wedge(), {})), wedge());
    EXPECT_TRUE(found.ok()) << found.findings.texts().front();
    ASSERT_EQ(found.findings.count(FindingKind::moved_images), 1U) << "parts are centred on the display";
    EXPECT_NE(found.findings.texts().front().find("shifted by (-4.4"), std::string::npos)
        << found.findings.texts().front();
    EXPECT_LT(found.max_area_error_mm2.value_or(9), 0.3);
}

TEST(ImageCheck, NamesMirroredParts) {
    // The file says that its images are mirrored along x, as they are for this printer; these are not.
    std::string mirrored = goo_of(wedge(), {.mirror_x = false});
    mirrored[195318] = 1;
    const Verification found = verified(read(mirrored), wedge());
    EXPECT_FALSE(found.ok());
    EXPECT_EQ(found.findings.texts().front(), "the images show the part of the mesh mirrored along x");
    std::string turned = goo_of(wedge(), {.mirror_x = false, .mirror_y = true});
    turned[195318] = 1;
    turned[195319] = 0;
    EXPECT_EQ(verified(read(turned), wedge()).findings.texts().front(),
              "the images show the part of the mesh rotated by half a turn");
}

TEST(ImageCheck, NamesRotations) {
    const std::vector<LayerShape> shapes{{{20, 30, 50}, 18, Box2{0, 0, 4, 5}},
                                         {{12, 15, 20}, 16, Box2{0, 0, 4, 4}}};
    // A rotation to the left takes (x, y) to (-y, x).
    const std::vector<LayerShape> rotated{{{20, -50, 30}, 18, Box2{-5, 0, 0, 4}},
                                          {{12, -20, 15}, 16, Box2{-4, 0, 0, 4}}};
    const PixelGrid grid{.ux = 20, .vy = 20};
    const std::vector<Layer> planes(2);
    EXPECT_EQ(compare_images(rotated, shapes, planes, grid).findings.texts().front(),
              "the images show the part of the mesh rotated by a quarter turn to the left");
    EXPECT_TRUE(compare_images(shapes, shapes, planes, grid).findings.empty());
}

TEST(ImageCheck, FindsOtherParts) {
    const LayerFile file = read(goo_of(wedge(), {}));
    const Verification found = verified(file, test::box_mesh({0, 0, 5}, {9, 5, 7}));
    EXPECT_FALSE(found.ok());
    EXPECT_GT(found.findings.count(FindingKind::other_areas), 10U);
}

TEST(CompareImages, CountsPixelsAndExposures) {
    const std::string bytes = goo_of(wedge(), {});
    const LayerFile first = read(bytes);
    EXPECT_TRUE(compare_files(first, read(bytes)).agree());
    const FileComparison coarse = compare_files(first, read(goo_of(wedge(), {.raster = {.antialias = 1}})));
    EXPECT_FALSE(coarse.agree());
    EXPECT_GT(coarse.details[3].other_pixels.value_or(0), 20U);
    EXPECT_GE(coarse.details[3].largest_pixel_difference, 64U);
    EXPECT_LE(coarse.details[3].largest_pixel_difference, 192U);
    LayerFile longer = read(bytes);
    longer.resin->exposures_s[7] += 1;
    const FileComparison exposures = compare_files(first, longer);
    ASSERT_EQ(exposures.parameters.size(), 1U);
    EXPECT_EQ(exposures.parameters[0].label, "layer 7");
    EXPECT_EQ(exposures.parameters[0].parameter, "exposure_s");
    EXPECT_EQ(exposures.parameters[0].second, exposures.parameters[0].first + 1);
}

} // namespace
} // namespace lamella::image_check_cases
