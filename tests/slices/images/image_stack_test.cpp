#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/png_file.hpp"
#include "fixtures/sample_layers.hpp"
#include "slices/images/layer_images.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

namespace lamella {
namespace {

namespace fs = std::filesystem;

TEST(ImageFolder, HasOneImageForEachLayerAndAListOfThem) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    write_layers(folder.file("out"), layer_format("png", ""), test::planes_of(layers), info_of(layers),
                 {.image = {.pixel_mm = {{0.1, 0.1}}}});
    EXPECT_EQ(folder.entries(), std::vector<std::string>{"out"});
    for (const char* name : {"out/00000.png", "out/00001.png"}) {
        const PngFile image = read_png(file_bytes(folder.file(name)));
        EXPECT_EQ(image.error, "");
        ASSERT_EQ(image.width, 100U);
        ASSERT_EQ(image.height, 100U);
        // The hole is at 2 to 4 from the left and from below.
        for (std::size_t r = 0; r < 100; ++r)
            for (std::size_t c = 0; c < 100; ++c)
                ASSERT_EQ(image.values[100 * r + c], c >= 20 && c < 40 && r >= 60 && r < 80 ? 0 : 255);
    }
    const std::string manifest = file_bytes(folder.file("out/manifest.json"));
    EXPECT_NE(manifest.find("\"column\": [10, 0, 0],\n  \"row\": [0, -10, 100],"), std::string::npos)
        << manifest;
    EXPECT_NE(
        manifest.find("{\"file\": \"00001.png\", \"z\": 0.75, \"bottom\": 0.5, \"top\": 1, \"area_mm2\": 96"),
        std::string::npos)
        << manifest;
}

TEST(ImageFolder, ShowsTheAreaOfEachLayer) {
    const LayerStack layers = random_layers(4, 8, 20, {3, 4}, false);
    const TemporaryFolder folder;
    write_layers(folder.file("out"), layer_format("png", ""), test::planes_of(layers), info_of(layers),
                 {.image = {.pixel_mm = {{0.02, 0.04}}}});
    std::vector<std::string> names;
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const PngFile image = read_png(file_bytes(folder.file("out/0000" + std::to_string(i) + ".png")));
        double covered = 0;
        for (const std::uint8_t value : image.values)
            covered += value / 255.0;
        double once = 0; // each ring alone, so that no two overlap
        for (std::size_t r = 0; r < layers[i].rings; ++r)
            once += std::abs(ring_area(layers[i].contour(r)));
        EXPECT_LE(covered * 0.02 * 0.04, once + 1e-3 * measure(layers[i]).perimeter_mm);
        EXPECT_GE(covered > 0, layers[i].rings > 0);
    }
}

TEST(ImageFolder, PutsAllPartsIntoOneImage) {
    const TemporaryFolder folder;
    LayerBuilder left;
    LayerBuilder right;
    add_contour(left, {{0, 0}, {4, 0}, {4, 10}, {0, 10}});
    add_contour(right, {{3, 0}, {10, 0}, {10, 10}, {3, 10}});
    const std::vector<LayerStack> parts{{left.finish(0, 0.5, 0, 1)}, {right.finish(0, 0.5, 0, 1)}};
    LayerFileInfo info{.box = {{0, 0, 0}, {10, 10, 1}}, .layers = 1, .bottom = 0};
    info.parts.resize(2);
    write_layers(folder.file("out"), layer_format("png", ""), test::planes_of(parts), info);
    const PngFile image = read_png(file_bytes(folder.file("out/00000.png")));
    EXPECT_EQ(image.values, std::vector<std::uint8_t>(200 * 200, 255));
}

TEST(ImageFolder, ReplacesWhatItMadeAndNothingElse) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    const LayerFormat& format = layer_format("png", "");
    write_layers(folder.file("out"), format, test::planes_of(layers), info_of(layers));
    LayerStack one{layers.front()};
    write_layers(folder.file("out"), format, test::planes_of(one), info_of(one));
    EXPECT_FALSE(fs::exists(folder.file("out/00001.png")));
    write_file(folder.file("out/00007.txt"), "mine");
    EXPECT_THROW(write_layers(folder.file("out"), format, test::planes_of(one), info_of(one)), Error);
    EXPECT_EQ(file_bytes(folder.file("out/00007.txt")), "mine");
    // Pictures without our list could be anybody's.
    fs::remove(folder.file("out/00007.txt"));
    fs::remove(folder.file("out/manifest.json"));
    EXPECT_THROW(write_layers(folder.file("out"), format, test::planes_of(one), info_of(one)), Error);
    EXPECT_TRUE(fs::exists(folder.file("out/00000.png")));
}

TEST(ImageFolder, RefusesTwoLayersOfOneIndex) {
    LayerStack layers = square_with_hole();
    layers[1].index = 0;
    for (const char* name : {"png", "png-zip"}) {
        const TemporaryFolder folder;
        EXPECT_THROW(write_layers(folder.file("out"), layer_format(name, ""), test::planes_of(layers),
                                  info_of(layers)),
                     Error);
        EXPECT_TRUE(folder.entries().empty()) << name;
    }
}

TEST(ImageArchive, HasTheImagesOfTheFolderInFront) {
    const TemporaryFolder folder;
    const LayerStack layers = square_with_hole();
    write_layers(folder.file("out.zip"), layer_format("", "out.zip"), test::planes_of(layers),
                 info_of(layers));
    write_layers(folder.file("out"), layer_format("png", ""), test::planes_of(layers), info_of(layers));
    const std::string archive = file_bytes(folder.file("out.zip"));
    EXPECT_EQ(archive.substr(0, 2), "PK");
    for (const char* name : {"out/00000.png", "out/00001.png"})
        EXPECT_NE(archive.find(file_bytes(folder.file(name))), std::string::npos) << name;
}

} // namespace
} // namespace lamella
