#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "fixtures/png_file.hpp"
#include "fixtures/sample_layers.hpp"
#include "raster/grey_values.hpp"
#include "slices/images/layer_images.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {
namespace {

TEST(LayerImages, CoverOnceWhatOverlaps) {
    const PixelGrid grid{.width = 60, .height = 60, .u0 = 30, .v0 = 30};
    const LayerImages images(PlaneDrawing(grid, {}, {}));
    const LayerStack layers = random_layers(9, 60, 50, {0, 0}, false);
    int overlapping = 0;
    for (std::size_t i = 1; i < layers.size(); ++i) {
        const std::span<const Layer> parts(&layers[i - 1], 1 + i % 2);
        overlapping += winds_once(parts) ? 0 : 1;
        const PngFile image = read_png(
            std::string(images.image(Plane(std::vector<Layer>(parts.begin(), parts.end()))).file->view()));
        const GreyImage expected = paint(parts, grid);
        std::size_t others = 0;
        for (std::size_t k = 0; k < expected.values.size(); ++k) {
            ASSERT_NEAR(image.values[k], expected.values[k], 1);
            others += image.values[k] != expected.values[k] ? 1 : 0;
        }
        ASSERT_LE(others, 1U) << "rounded another way";
    }
    EXPECT_GT(overlapping, 20);
    EXPECT_LT(overlapping, 59);
}

TEST(LayerImages, AHoleWhoseOuterContourIsOpenIsNoBody) {
    const LayerImages images(PlaneDrawing({.width = 60, .height = 60, .u0 = 0, .v0 = 0}, {}, {}));
    const auto covered = [&](bool torn) {
        LayerBuilder builder;
        add_contour(builder, {{5, 5}, {5, 15}, {15, 15}, {15, 5}});
        add_contour(builder, {{0, 0}, {20, 0}, {20, 20}, {0, 20}}, !torn);
        add_contour(builder, {{30, 0}, {34, 0}, {34, 5}, {30, 5}});
        const std::vector<Layer> parts{builder.finish(0, 0.5, 0, 1)};
        return images.image(Plane(parts)).areas.covered;
    };
    EXPECT_EQ(covered(false), 20 * 20 - 10 * 10 + 4 * 5);
    EXPECT_EQ(covered(true), 4 * 5) << "what is whole is drawn";

    // A body inside out, and a torn one somewhere else.
    LayerBuilder builder;
    add_contour(builder, {{0, 0}, {0, 10}, {10, 10}, {10, 0}});
    add_contour(builder, {{30, 0}, {34, 0}, {34, 5}}, false);
    const std::vector<Layer> apart{builder.finish(0, 0.5, 0, 1)};
    EXPECT_EQ(images.image(Plane(apart)).areas.covered, 10 * 10);
}

TEST(LayerImages, NumberThePartThatCoversMostOfAPixelAmongThoseAroundItsCentre) {
    const PixelGrid grid{.width = 60, .height = 60, .u0 = 30, .v0 = 30};
    const LayerStack layers = random_layers(5, 12, 50, {0, 0}, false);
    std::vector<std::uint8_t> expected(std::size_t{60} * 60);
    std::vector<int> largest(expected.size(), -1);
    for (std::size_t part = 0; part < layers.size(); ++part) {
        const GreyImage centres = paint({&layers[part], 1}, grid, {.antialias = 1});
        const GreyImage shares = paint({&layers[part], 1}, grid, {.antialias = most_antialias});
        for (std::size_t k = 0; k < expected.size(); ++k)
            if (centres.values[k] > 0 && shares.values[k] > largest[k]) {
                largest[k] = shares.values[k];
                expected[k] = static_cast<std::uint8_t>(part + 1);
            }
    }
    std::vector<std::uint8_t> numbers;
    const RasterAreas areas = draw_part_numbers(layers, grid, [&](auto row, auto times) {
        for (std::uint32_t i = 0; i < times; ++i)
            for (std::uint32_t k = 0, run = 0; k < 60; ++k) {
                run += row[run].end == k ? 1 : 0;
                numbers.push_back(row[run].value);
            }
    });
    EXPECT_EQ(numbers, expected);
    EXPECT_EQ(areas.covered,
              static_cast<double>(std::count_if(expected.begin(), expected.end(),
                                                [](std::uint8_t number) { return number > 0; })));
}

TEST(LayerImages, ShowTheMeanOfCuts) {
    const PixelGrid grid{.width = 60, .height = 60, .u0 = 30, .v0 = 30};
    const LayerStack layers = random_layers(4, 12, 50, {0, 0}, false);
    const auto drawn = [&](const Plane& plane, const RasterOptions& options) {
        return read_png(std::string(LayerImages(PlaneDrawing(grid, options, {})).image(plane).file->view()))
            .values;
    };
    for (const RasterOptions& options :
         {RasterOptions{}, RasterOptions{.antialias = 1}, RasterOptions{.gamma = 2},
          RasterOptions{.grey_values = grey_curve(std::vector<GreyPoint>{{0, 60}})}}) {
        const GreyValues values = values_of(options);
        Plane plane(layers.front());
        std::vector<unsigned> sums(std::size_t{60} * 60);
        for (std::size_t i = 0; i < 5; ++i) {
            plane.cuts.push_back({layers[2 * i], layers[2 * i + 1]});
            const auto cut = drawn(Plane(plane.cuts.back()), {.antialias = options.antialias});
            for (std::size_t k = 0; k < sums.size(); ++k)
                sums[k] += cut[k];
        }
        const auto mean = drawn(plane, options);
        for (std::size_t k = 0; k < sums.size(); ++k) {
            const unsigned value = values[(sums[k] + 2) / 5];
            ASSERT_EQ(mean[k], options.antialias == 1 ? (sums[k] >= 3 * 255 ? 255 : 0) : value);
        }
        const double covered = LayerImages(PlaneDrawing(grid, options, {})).image(plane).areas.covered;
        double sum = 0;
        for (const std::vector<Layer>& cut : plane.cuts)
            sum += LayerImages(PlaneDrawing(grid, options, {})).image(Plane(cut)).areas.covered;
        EXPECT_NEAR(covered, sum / 5, 1e-9);
    }
}

} // namespace
} // namespace lamella
