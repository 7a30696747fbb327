#include "lamella/core/error.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/png_file.hpp"
#include "fixtures/sample_layers.hpp"
#include "temporary_folder.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

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
        write_layers(folder.file("job.sl1"), layer_format("", "job.sl1"), test::planes_of(layers),
                     info_of(layers), options);
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
    EXPECT_EQ(refusal(stack_of({0.05, 0.049998, 0.0500011, 0.05})), "")
        << "heights of a file that rounds them";
    EXPECT_NE(refusal(stack_of({0.1, 0.1, 0.2})).find("layer 2 is 0.2 mm thick, the one before 0.1 mm"),
              std::string::npos);
}

TEST(Sl1, RefusesExposuresThatAreNone) {
    const LayerStack layers = stack_of({0.1, 0.1});
    EXPECT_NE(refusal(layers, {.resin = {.exposure_s = 0}}).find("an exposure of 0 s"), std::string::npos);
    EXPECT_NE(refusal(layers, {.resin = {.bottom_exposure_s = std::numeric_limits<double>::infinity()}})
                  .find("a bottom exposure of inf s"),
              std::string::npos);
}

TEST(Sl1, RefusesPartsLargerThanTheDisplay) {
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {121, 0}, {121, 50}});
    EXPECT_NE(refusal({builder.finish(0, 0.05, 0, 0.1)})
                  .find("the display of the Original Prusa SL1 only 120.96 x 68.04 mm"),
              std::string::npos);
}

/// The entry of an archive that is stored.
PngFile stored_image(const std::string& archive, const std::string& name) {
    const std::size_t begin = archive.find("\x89PNG", archive.find(name));
    const std::size_t end = archive.find("IEND", begin) + 8;
    return read_png(archive.substr(begin, end - begin));
}

TEST(Sl1, ShowsItsImagesUpright) {
    // x runs up the picture and y to the right; the display has 2560 rows and 1440 columns.
    const TemporaryFolder folder;
    const LayerStack layers = stack_of({0.1});
    write_layers(folder.file("job.sl1"), layer_format("", "job.sl1"), test::planes_of(layers),
                 info_of(layers), {.image = {.raster = {.antialias = 1}}});
    const PngFile image = stored_image(file_bytes(folder.file("job.sl1")), "job00000.png");
    ASSERT_EQ(image.error, "");
    ASSERT_EQ(image.width, 1440U);
    ASSERT_EQ(image.height, 2560U);
    const auto at = [&](double x,
                        double y) { // from the part's lower left corner, which is off the middle by 5
        const auto column = static_cast<std::size_t>(720 + (y - 5) / 0.04725);
        const auto row = static_cast<std::size_t>(1280 - (x - 5) / 0.04725);
        return image.values[row * 1440 + column];
    };
    EXPECT_EQ(at(9, 1), 255);
    EXPECT_EQ(at(9, 8), 255);
    EXPECT_EQ(at(1, 2), 0);
    EXPECT_EQ(at(3, 9), 0);
}

TEST(Sl1, HasImagesOfThePart) {
    const TemporaryFolder folder;
    const LayerStack layers = stack_of({1, 1, 1, 1, 1, 1});
    write_layers(folder.file("job.sl1"), layer_format("", "job.sl1"), test::planes_of(layers),
                 info_of(layers));
    const std::string archive = file_bytes(folder.file("job.sl1"));
    for (const std::uint32_t width : {400U, 800U}) {
        const std::uint32_t height = width == 400 ? 400 : 480;
        const PngFile image =
            stored_image(archive, fmt::format("thumbnail/thumbnail{}x{}.png", width, height));
        ASSERT_EQ(image.error, "");
        EXPECT_EQ(image.width, width);
        EXPECT_EQ(image.height, height);
        EXPECT_EQ(image.bits, 8);
        EXPECT_EQ(image.colour_type, PNG_COLOR_TYPE_RGBA);
        const auto alpha = [&](std::size_t column, std::size_t row) {
            return image.values[4 * (row * width + column) + 3];
        };
        EXPECT_EQ(alpha(width / 2, height / 2), 255);
        EXPECT_EQ(alpha(3, 3), 0);
    }
}

TEST(Sl1, HasTheSameBytesInWhateverOrderLayersAreMade) {
    const TemporaryFolder folder;
    const LayerStack layers = stack_of({1, 1, 1, 1, 1, 1});
    write_layers(folder.file("a.sl1"), layer_format("", "a.sl1"), test::planes_of(layers), info_of(layers));
    std::filesystem::create_directory(folder.path() / "other"); // the pictures are named after the file
    const std::string other = (folder.path() / "other" / "a.sl1").string();
    const auto writer = open_layer_writer(other, layer_format("", other), info_of(layers));
    std::vector<Commit> ready(layers.size());
    for (std::size_t i = layers.size(); i-- > 0;)
        ready[i] = writer->prepare(layers[i]);
    for (const auto& write : ready)
        write();
    writer->finish();
    EXPECT_TRUE(file_bytes(other) == file_bytes(folder.file("a.sl1")));
}

} // namespace
} // namespace lamella
