#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/raster/image.hpp"

#include "fixtures/random.hpp"
#include "raster/outlines.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella::outlines_cases {
namespace {

RunImage image_of(std::uint32_t width, const std::vector<std::uint8_t>& values) {
    RunImage image{width, static_cast<std::uint32_t>(values.size() / width), {}};
    for (std::size_t i = 0; i < values.size(); ++i) {
        if (image.runs.empty() || image.runs.back().value != values[i])
            image.runs.push_back({i, values[i]});
        image.runs.back().end = i + 1;
    }
    return image;
}

/// A `#` is white, anything else black.
RunImage drawn(std::uint32_t width, std::string_view pixels) {
    std::vector<std::uint8_t> values;
    for (const char c : pixels)
        values.push_back(c == '#' ? 255 : 0);
    return image_of(width, values);
}

/// Pixels of 1 mm, with y upwards.
PixelGrid upright(const RunImage& image) {
    return {.width = image.width, .height = image.height, .vy = -1, .v0 = static_cast<double>(image.height)};
}

TEST(Outlines, OfASquareAreItsFourCorners) {
    const RunImage image = drawn(4, "...."
                                    ".##."
                                    ".##."
                                    "....");
    const Layer layer = outlines(image, upright(image));
    ASSERT_EQ(layer.contours(), 1U);
    EXPECT_EQ(layer.rings, 1U);
    const std::vector<Point2> square{{1, 1}, {3, 1}, {3, 3}, {1, 3}};
    EXPECT_EQ(std::vector<Point2>(layer.points.begin(), layer.points.end()), square);
}

TEST(Outlines, SeparatePixelsThatTouchAtACorner) {
    const RunImage image = drawn(2, "#."
                                    ".#");
    EXPECT_EQ(outlines(image, upright(image)).contours(), 2U);
    const RunImage other = drawn(2, ".#"
                                    "#.");
    EXPECT_EQ(outlines(other, upright(other)).contours(), 2U);
}

TEST(Outlines, RunClockwiseAroundHoles) {
    const RunImage image = drawn(3, "###"
                                    "#.#"
                                    "###");
    const Layer layer = outlines(image, upright(image));
    ASSERT_EQ(layer.contours(), 2U);
    EXPECT_EQ(ring_area(layer.contour(0)) + ring_area(layer.contour(1)), 8);
    EXPECT_EQ(std::min(ring_area(layer.contour(0)), ring_area(layer.contour(1))), -1);
}

TEST(Outlines, TakePixelsOfAtLeastTheThreshold) {
    const RunImage image = image_of(4, {0, 127, 128, 255});
    EXPECT_EQ(bright_pixels(image).count, 2U);
    EXPECT_EQ(bright_pixels(image, 1).count, 3U);
    EXPECT_EQ(bright_pixels(image).left, 2U);
    EXPECT_EQ(bright_pixels(image).right, 4U);
    EXPECT_EQ(bright_pixels(image).top, 0U);
    EXPECT_EQ(bright_pixels(image).bottom, 1U);
}

TEST(Outlines, OfNothingAreEmpty) {
    const RunImage image = drawn(2, "....");
    EXPECT_EQ(outlines(image, upright(image)).contours(), 0U);
    EXPECT_EQ(bright_pixels(image).count, 0U);
    EXPECT_EQ(bright_pixels(image).right, 0U);
}

TEST(Outlines, OfRunsOverManyRowsAreThoseOfTheWholeImage) {
    const RunImage image{3, 1000, {{3000, 255}}};
    const Layer layer = outlines(image, upright(image));
    EXPECT_EQ(layer.points.size(), 4U);
    EXPECT_EQ(ring_area(layer.contour(0)), 3000);
}

/// Returns the edges of pixels between bright and dark ones.
std::size_t boundary_edges(const RunImage& image, const std::vector<std::uint8_t>& values) {
    const auto bright = [&](std::int64_t column, std::int64_t row) {
        return column >= 0 && row >= 0 && column < image.width && row < image.height &&
               values[static_cast<std::size_t>(row * image.width + column)] >= bright_from;
    };
    std::size_t edges = 0;
    for (std::int64_t row = 0; row <= image.height; ++row)
        for (std::int64_t column = 0; column <= image.width; ++column)
            edges += (bright(column, row) != bright(column - 1, row) ? 1 : 0) +
                     (bright(column, row) != bright(column, row - 1) ? 1 : 0);
    return edges;
}

TEST(Outlines, GiveThePixelsBackWhenTheyAreDrawn) {
    test::Random random(77);
    for (int round = 0; round < 300; ++round) {
        const auto width = static_cast<std::uint32_t>(random.integer(1, 9));
        const auto height = static_cast<std::uint32_t>(random.integer(1, 9));
        std::vector<std::uint8_t> values(std::size_t{width} * height);
        for (std::uint8_t& value : values)
            value = random.integer(0, 2) == 0 ? 0 : random.integer(0, 1) == 0 ? 255 : 100;
        const RunImage image = image_of(width, values);
        PixelGrid grid{.width = width,
                       .height = height,
                       .ux = round % 2 == 0 ? 2.0 : -2.0,
                       .u0 = 3,
                       .vy = round % 4 < 2 ? 4.0 : -4.0,
                       .v0 = 1};
        if (round % 3 == 0) { // upright displays
            std::swap(grid.ux, grid.uy);
            std::swap(grid.vx, grid.vy);
        }
        const Layer layer = outlines(image, grid);
        EXPECT_TRUE(in_normal_form(layer));
        EXPECT_EQ(layer.points.size(), bright_pixels(image).corners);
        double area = 0;
        double length = 0;
        for (std::size_t i = 0; i < layer.contours(); ++i) {
            area += ring_area(layer.contour(i));
            const std::span<const Point2> ring = layer.contour(i);
            for (std::size_t k = 0; k < ring.size(); ++k) {
                const Point2& a = ring[k];
                const Point2& b = ring[(k + 1) % ring.size()];
                const Point2& c = ring[(k + 2) % ring.size()];
                EXPECT_NE(a.x == b.x, b.x == c.x) << "collinear points";
                length +=
                    std::abs((b.x - a.x) * (grid.ux + grid.vx)) + std::abs((b.y - a.y) * (grid.uy + grid.vy));
            }
        }
        EXPECT_DOUBLE_EQ(area * 8, static_cast<double>(bright_pixels(image).count)) << round;
        EXPECT_DOUBLE_EQ(length, static_cast<double>(boundary_edges(image, values)));
        const std::vector<Layer> layers{layer};
        const GreyImage again = paint(layers, grid, {.antialias = 1});
        for (std::size_t i = 0; i < values.size(); ++i)
            ASSERT_EQ(again.values[i] == 255, values[i] >= bright_from) << round;
    }
}

} // namespace
} // namespace lamella::outlines_cases
