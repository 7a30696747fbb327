#include "lamella/core/error.hpp"
#include "lamella/write/layer_writer.hpp"

#include "png_file.hpp"
#include "sample_layers.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace lamella {
namespace {

/// Layers of these thicknesses, one upon the other.
LayerStack stack_of(const std::vector<double>& thicknesses) {
    LayerStack layers;
    double bottom = 0;
    for (const double thickness : thicknesses) {
        LayerBuilder builder;
        add_contour(builder, {{0, 0}, {10, 0}, {10, 10}});
        layers.push_back(builder.finish(layers.size(), bottom + 0.5 * thickness, bottom, bottom + thickness));
        bottom += thickness;
    }
    return layers;
}

std::string refusal(const LayerStack& layers, const LayerWriteOptions& options = {}) {
    const TemporaryFolder folder;
    try {
        write_layers(folder.file("job.sl1"), layer_format("", "job.sl1"), layers, info_of(layers), options);
    } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::usage);
        EXPECT_TRUE(folder.entries().empty());
        return error.what();
    }
    return "";
}

TEST(Sl1, AllowsAnotherHeightForTheFirstLayerOnly) {
    EXPECT_EQ(refusal(stack_of({0.3, 0.1, 0.1, 0.1})), "");
    EXPECT_EQ(refusal(stack_of({0.3})), "");
    EXPECT_NE(refusal(stack_of({0.1, 0.1, 0.2})).find("layer 2 is 0.2 mm thick, the one before 0.1 mm"),
              std::string::npos);
}

TEST(Sl1, RefusesExposuresThatAreNone) {
    const LayerStack layers = stack_of({0.1, 0.1});
    EXPECT_NE(refusal(layers, {.exposure = {.normal_s = 0}}).find("an exposure of 0 s"), std::string::npos);
    EXPECT_NE(refusal(layers, {.exposure = {.first_s = std::numeric_limits<double>::infinity()}})
                  .find("a first exposure of inf s"),
              std::string::npos);
}

TEST(Sl1, RefusesPartsLargerThanTheDisplay) {
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {121, 0}, {121, 50}});
    EXPECT_NE(
        refusal({builder.finish(0, 0.05, 0, 0.1)}).find("the display of the SL1 only 120.96 x 68.04 mm"),
        std::string::npos);
}

TEST(Sl1, ShowsItsPicturesUpright) {
    // x runs up the picture and y to the right; the display has 2560 rows and 1440 columns.
    const TemporaryFolder folder;
    const LayerStack layers = stack_of({0.1});
    write_layers(folder.file("job.sl1"), layer_format("", "job.sl1"), layers, info_of(layers),
                 {.picture = {.raster = {.antialias = 1}}});
    const std::string archive = file_bytes(folder.file("job.sl1"));
    const std::size_t begin = archive.find("\x89PNG");
    const std::size_t end = archive.find("IEND") + 8;
    ASSERT_NE(begin, std::string::npos);
    const PngFile picture = read_png(archive.substr(begin, end - begin));
    ASSERT_EQ(picture.error, "");
    ASSERT_EQ(picture.width, 1440U);
    ASSERT_EQ(picture.height, 2560U);
    const auto at = [&](double x,
                        double y) { // from the part's lower left corner, which is off the middle by 5
        const auto column = static_cast<std::size_t>(720 + (y - 5) / 0.04725);
        const auto row = static_cast<std::size_t>(1280 - (x - 5) / 0.04725);
        return picture.values[row * 1440 + column];
    };
    EXPECT_EQ(at(9, 1), 255);
    EXPECT_EQ(at(9, 8), 255);
    EXPECT_EQ(at(1, 2), 0);
    EXPECT_EQ(at(3, 9), 0);
}

} // namespace
} // namespace lamella
