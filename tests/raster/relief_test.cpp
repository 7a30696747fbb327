#include "fixtures/layers.hpp"
#include "raster/relief.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace lamella {
namespace {

using test::layer_of;
using test::rectangle;

constexpr std::uint32_t side = 300;
constexpr Box3 box{{-5, 10, 2}, {15, 25, 12}};
// Turned by 30 degrees and seen from 35 degrees above the horizon.
const double turn = std::acos(-1.0) / 6;
const double view = std::acos(-1.0) * 35 / 180;

Layer range(double bottom, double top) {
    Layer layer = layer_of({rectangle(box.min.x, box.min.y, box.max.x, box.max.y)});
    layer.bottom = bottom;
    layer.top = top;
    layer.z = 0.5 * (bottom + top);
    return layer;
}

/// The box in so many layers.
ColourImage image_of_box(int layers) {
    Relief relief(box, side, side);
    const double height = (box.max.z - box.min.z) / layers;
    for (int i = 0; i < layers; ++i) {
        const Layer layer =
            range(box.min.z + i * height, i + 1 == layers ? box.max.z : box.min.z + (i + 1) * height);
        relief.add(relief.spans({&layer, 1}));
    }
    return relief.image();
}

double width_of_box() {
    return 20 * std::cos(turn) + 15 * std::sin(turn);
}
double height_of_box() {
    return (20 * std::sin(turn) + 15 * std::cos(turn)) * std::sin(view) + 10 * std::cos(view);
}
double scale() {
    return 0.9 * side / std::max(width_of_box(), height_of_box());
}

/// The pixel where a point of the box is seen.
std::array<int, 4> pixel_at(const ColourImage& image, const Point3& p) {
    const auto across = [](double x, double y) {
        return std::cos(turn) * x - std::sin(turn) * y;
    };
    const auto down = [](double x, double y, double z) {
        return -(std::sin(turn) * x + std::cos(turn) * y) * std::sin(view) - z * std::cos(view);
    };
    const auto column = static_cast<std::size_t>(0.5 * side + scale() * (across(p.x, p.y) - across(5, 17.5)));
    const auto row =
        static_cast<std::size_t>(0.5 * side + scale() * (down(p.x, p.y, p.z) - down(5, 17.5, 7)));
    const std::uint8_t* const at = &image.values[4 * (row * side + column)];
    return {at[0], at[1], at[2], at[3]};
}

std::size_t visible(const ColourImage& image) {
    std::size_t count = 0;
    for (std::size_t i = 3; i < image.values.size(); i += 4)
        count += image.values[i] != 0 ? 1 : 0;
    return count;
}

TEST(Relief, ShowsTheOutlineOfABox) {
    const double area = 20 * 15 * std::sin(view) + width_of_box() * 10 * std::cos(view);
    EXPECT_NEAR(static_cast<double>(visible(image_of_box(100))), area * scale() * scale(),
                0.01 * area * scale() * scale());
}

TEST(Relief, LightsTheSidesOfABoxByTheirSlope) {
    const ColourImage image = image_of_box(100);
    const auto top = pixel_at(image, {5, 17.5, 12});
    const auto left = pixel_at(image, {-5, 17.5, 7});
    const auto right = pixel_at(image, {5, 10, 7});
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_GT(top[k], left[k] + 10);
        EXPECT_GT(left[k], right[k] + 10);
        EXPECT_GT(right[k], 10);
    }
    EXPECT_EQ(top[3], 255);
    // Each side has one light, away from its edges.
    for (const double d : {-3.0, 3.0})
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(pixel_at(image, {5 + d, 17.5 + d, 12})[k], top[k], 6);
            EXPECT_NEAR(pixel_at(image, {-5, 17.5 + d, 7 + d / 2})[k], left[k], 20);
            EXPECT_NEAR(pixel_at(image, {5 + d, 10, 7 - d / 2})[k], right[k], 20);
        }
}

TEST(Relief, IsTheSameHoweverThinTheLayersAre) {
    const ColourImage one = image_of_box(1);
    for (const int layers : {2, 10, 128, 2000})
        EXPECT_TRUE(image_of_box(layers).values == one.values) << layers;
}

TEST(Relief, DrawsFewerLayersThanItHasRows) {
    const Relief relief(box, side, side);
    constexpr int layers = 20000;
    std::size_t drawn = 0;
    for (int i = 0; i < layers; ++i) {
        const Layer layer = range(2 + 10.0 * i / layers, 2 + 10.0 * (i + 1) / layers);
        drawn += relief.spans({&layer, 1}).empty() ? 0 : 1;
    }
    EXPECT_GT(drawn, side / 8);
    EXPECT_LT(drawn, side / 4);
}

TEST(Relief, ShowsPartsThatAreLowerThanAPixel) {
    const Box3 leaf{{0, 0, 5}, {20, 20, 5.001}};
    Relief relief(leaf, side, side);
    Layer layer = layer_of({rectangle(0, 0, 20, 20)});
    layer.bottom = 5;
    layer.top = 5.001;
    relief.add(relief.spans({&layer, 1}));
    EXPECT_GT(visible(relief.image()), side * side / 5);
}

TEST(Relief, HidesWhatLiesBehind) {
    // A wall in front of a lower one: of the latter nothing is seen through it, but all through its window.
    const auto image = [](bool window, bool behind) {
        Relief relief({{0, 0, 0}, {20, 20, 20}}, side, side);
        for (int i = 0; i < 40; ++i) {
            std::vector<test::Contour> rings;
            if (window && i > 5 && i < 35)
                rings = {rectangle(0, 0, 2, 1), rectangle(18, 0, 20, 1)};
            else
                rings = {rectangle(0, 0, 20, 1)};
            if (behind && i < 10)
                rings.push_back(rectangle(5, 2, 15, 3));
            Layer layer = layer_of(rings);
            layer.bottom = 0.5 * i;
            layer.top = 0.5 * (i + 1);
            relief.add(relief.spans({&layer, 1}));
        }
        return visible(relief.image());
    };
    EXPECT_EQ(image(false, true), image(false, false));
    EXPECT_GT(image(true, true), image(true, false) + 100);
}

TEST(Relief, OfNothingIsTransparent) {
    EXPECT_EQ(visible(Relief(box, side, side).image()), 0U);
    EXPECT_EQ(visible(Relief(Box3{}, side, side).image()), 0U);
    EXPECT_EQ(visible(fitted(Relief(box, side, side).image(), 40, 30)), 0U);
}

TEST(Fitted, PutsWhatIsSeenIntoTheMiddle) {
    ColourImage image{100, 100, std::vector<std::uint8_t>(40000)};
    for (std::size_t row = 60; row < 100; ++row)
        for (std::size_t column = 0; column < 20; ++column)
            for (std::size_t k = 0; k < 4; ++k)
                image.values[4 * (row * 100 + column) + k] = k == 3 ? 255 : 200;
    for (const auto& [width, height, wide, tall] :
         {std::array<std::uint32_t, 4>{60, 80, 20, 40}, {100, 20, 9, 18}, {10, 100, 9, 18}}) {
        const ColourImage small = fitted(image, width, height);
        std::size_t left = width;
        std::size_t right = 0;
        std::size_t top = height;
        std::size_t bottom = 0;
        for (std::size_t row = 0; row < height; ++row)
            for (std::size_t column = 0; column < width; ++column) {
                const std::uint8_t* const pixel = &small.values[4 * (row * width + column)];
                if (pixel[3] == 0)
                    continue;
                EXPECT_EQ(pixel[0], 200);
                left = std::min(left, column);
                right = std::max(right, column + 1);
                top = std::min(top, row);
                bottom = std::max(bottom, row + 1);
            }
        EXPECT_NEAR(static_cast<double>(right - left), wide, 2);
        EXPECT_NEAR(static_cast<double>(bottom - top), tall, 2);
        EXPECT_NEAR(static_cast<double>(left + right), width, 2);
        EXPECT_NEAR(static_cast<double>(top + bottom), height, 2);
    }
}

} // namespace
} // namespace lamella
