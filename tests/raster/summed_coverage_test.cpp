#include "lamella/contour/measure.hpp"
#include "lamella/raster/image.hpp"

#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "raster/clipped_area.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace lamella {
namespace {

using test::Contour;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;

/// A ring around its middle whose points lie in no more than an octant from one another.
Contour ring(Random& random, const Point2& middle, double least, double most, int points, bool stepped) {
    Contour result;
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i / points;
        const double radius = random.real(least, most);
        Point2 p{middle.x + radius * std::cos(angle), middle.y + radius * std::sin(angle)};
        if (stepped && i % 2 == 1)
            (i % 4 == 1 ? p.x : p.y) = i % 4 == 1 ? result.back().x : result.back().y;
        result.push_back(p);
    }
    return result;
}

/// Rings with holes with islands side by side: nothing crosses. Sizes from less than a pixel to more than the
/// picture.
Layer clean_layer(Random& random, double width, double height, bool stepped) {
    std::vector<Contour> rings;
    const auto columns = static_cast<int>(random.integer(1, 5));
    const double cell = std::max(width, height) / columns;
    for (int column = 0; column < columns; ++column)
        for (int row = 0; row < columns; ++row) {
            const Point2 middle{(column + 0.5) * cell - 0.2 * width, (row + 0.5) * cell - 0.2 * height};
            const int points = 8 * static_cast<int>(random.integer(1, random.integer(0, 3) == 0 ? 400 : 6));
            rings.push_back(ring(random, middle, 0.4 * cell, 0.49 * cell, points, false));
            rings.push_back(reversed(ring(random, middle, 0.2 * cell, 0.25 * cell, points, false)));
            rings.push_back(ring(random, middle, 0.05 * cell, 0.12 * cell, 8, stepped));
        }
    return layer_of(rings);
}

struct Drawn {
    GreyImage image;
    double covered = 0;
};

Drawn drawn(std::span<const Layer> parts, const PixelGrid& grid) {
    const RasterOptions options{.antialias = 8, .winds_once = true};
    return {paint(parts, grid, options), rasterise(parts, grid, options, [](auto, auto) {}).covered};
}

/// Compares each pixel with the sum of the rings' areas in it, each ring cut off at the pixel's sides.
void expect_right(std::span<const Layer> parts, const PixelGrid& grid, const std::string& what) {
    const Drawn found = drawn(parts, grid);
    const double upright = grid.ux * grid.vy > grid.uy * grid.vx ? 1 : -1;
    std::vector<Contour> rings;
    for (const Layer& layer : parts)
        for (std::size_t i = 0; i < layer.rings; ++i) {
            Contour& ring = rings.emplace_back();
            for (const Point2& p : layer.contour(i))
                ring.push_back(
                    {grid.ux * p.x + grid.uy * p.y + grid.u0, grid.vx * p.x + grid.vy * p.y + grid.v0});
        }
    double covered = 0;
    std::vector<double> area(grid.width);
    for (std::uint32_t r = 0; r < grid.height; ++r) {
        std::fill(area.begin(), area.end(), 0);
        for (const Contour& ring : rings) {
            const Contour here = test::cut_off_in_row(ring, r);
            if (here.size() < 3)
                continue;
            for (std::uint32_t c = 0; c < grid.width; ++c) {
                const Contour rest = test::cut_off_in_column(here, c);
                if (rest.size() >= 3)
                    area[c] += upright * ring_area(rest);
            }
        }
        for (std::uint32_t c = 0; c < grid.width; ++c) {
            ASSERT_NEAR(found.image.row(r)[c], 255 * std::clamp(area[c], 0.0, 1.0), 0.5 + 1e-6)
                << what << ", column " << c << ", row " << r;
            covered += std::clamp(area[c], 0.0, 1.0);
        }
    }
    ASSERT_NEAR(found.covered, covered, 1e-6) << what;
}

TEST(SummedCoverage, IsExactWhereNothingIsCoveredTwice) {
    constexpr std::array<std::array<std::uint32_t, 2>, 6> sizes{
        {{1, 1}, {7, 130}, {64, 64}, {65, 33}, {150, 60}, {1500, 4}}};
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
        Random random(seed);
        const auto& [width, height] = sizes[seed % sizes.size()];
        const Layer layer = clean_layer(random, width, height, seed % 3 == 0);
        expect_right({&layer, 1}, {.width = width, .height = height}, "seed " + std::to_string(seed));
    }
}

TEST(SummedCoverage, IsExactWhicheverWayTheImageLies) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        const Layer layer = clean_layer(random, 10, 10, seed % 2 == 0);
        const double angle = random.real(0, 7);
        const double scale = random.real(2, 20);
        PixelGrid grid{.width = 150, .height = 130};
        grid.ux = scale * std::cos(angle);
        grid.uy = -scale * std::sin(angle);
        grid.vx = scale * std::sin(angle);
        grid.vy = scale * std::cos(angle);
        if (seed % 3 == 0)
            std::swap(grid.ux, grid.vx), std::swap(grid.uy, grid.vy); // mirrored
        grid.u0 = 75 - 5 * (grid.ux + grid.uy);
        grid.v0 = 65 - 5 * (grid.vx + grid.vy);
        expect_right({&layer, 1}, grid, "seed " + std::to_string(seed));
    }
}

TEST(SummedCoverage, TakesEdgesAlongTheBordersOfPixelsAndBands) {
    for (std::uint32_t side = 1; side < 140; side += 9) {
        const double end = side;
        const Layer layer = layer_of({rectangle(0, 0, end, end), reversed(rectangle(0, 0, end / 2, end / 2)),
                                      rectangle(end + 1, -5, end + 300, end + 5)});
        expect_right({&layer, 1}, {.width = 150, .height = 145}, "side " + std::to_string(side));
    }
}

TEST(SummedCoverage, UnitesParts) {
    Random random(8);
    const std::vector<Layer> parts{
        layer_of({ring(random, {30, 30}, 20, 28, 64, false)}), Layer{},
        layer_of({ring(random, {90, 30}, 20, 28, 64, false), reversed(rectangle(85, 25, 95, 35))}),
        layer_of({}, {{{0, 0}, {9, 0}, {9, 9}}})};
    expect_right(parts, {.width = 120, .height = 60}, "parts");
}

TEST(SummedCoverage, TakesRingsOfNoneAndOfFewPoints) {
    Layer layer = layer_of({rectangle(1, 1, 3, 3), {{5, 5}}, {{5, 1}, {6, 4}}});
    layer.offsets.push_back(layer.offsets.back());
    ++layer.rings;
    EXPECT_EQ(drawn({&layer, 1}, {.width = 10, .height = 10}).covered, 4);
}

TEST(SummedCoverage, HasTheAreaOfContoursMuchFinerThanPixels) {
    Random random(4);
    std::vector<Contour> rings;
    for (int column = 0; column < 10; ++column)
        for (int row = 0; row < 10; ++row)
            rings.push_back(ring(random, {column + 0.5, row + 0.5}, 0.3, 0.31, 3000, false));
    const Layer layer = layer_of(rings);
    const double area = measure(layer).area_mm2;
    for (const double pixels_per_mm : {0.1, 1.0, 7.0, 30.0}) {
        const auto side = static_cast<std::uint32_t>(std::ceil(10 * pixels_per_mm));
        const PixelGrid grid{.width = side, .height = side, .ux = pixels_per_mm, .vy = pixels_per_mm};
        const double covered =
            rasterise({&layer, 1}, grid, {.antialias = 8, .winds_once = true}, [](auto, auto) {}).covered;
        EXPECT_NEAR(covered / (pixels_per_mm * pixels_per_mm), area, 1e-11 * area);
    }
}

TEST(SummedCoverage, TakesRowsThatAreTheSameTogether) {
    const Layer layer = layer_of({rectangle(10, 100, 90, 900)});
    std::vector<std::uint32_t> times;
    rasterise({&layer, 1}, {.width = 100, .height = 1000}, {.winds_once = true},
              [&](auto, std::uint32_t n) { times.push_back(n); });
    EXPECT_EQ(times, (std::vector<std::uint32_t>{100, 800, 100}));
}

TEST(SummedCoverage, CountsPlacesThatAreCoveredSeveralTimesUpToTheWholePixel) {
    const Contour body = rectangle(2, 2, 8, 8);
    const Layer layer = layer_of({body, body, rectangle(0.25, 0.5, 0.75, 1), rectangle(0.25, 0.5, 0.75, 1)});
    const Drawn found = drawn({&layer, 1}, {.width = 10, .height = 10});
    EXPECT_EQ(found.covered, 36 + 0.5);
    EXPECT_EQ(found.image.row(0)[0], 128);
    EXPECT_EQ(std::count(found.image.values.begin(), found.image.values.end(), 255), 36);
}

TEST(SummedCoverage, DrawsTheLargestImage) {
    const double side = most_pixels;
    const Layer layer = layer_of({{{0, 0}, {side, 0}, {side, side}}});
    const PixelGrid grid{.width = most_pixels, .height = most_pixels};
    const double covered = rasterise({&layer, 1}, grid, {.winds_once = true}, [](auto, auto) {}).covered;
    EXPECT_NEAR(covered, 0.5 * side * side, 1);
}

TEST(SummedCoverage, StandsNumbersOfAnySize) {
    for (const double far : {1e6, 1e18, 1e300}) {
        const Layer layer = layer_of({rectangle(-far, -far, far, far)});
        const Drawn found = drawn({&layer, 1}, {.width = 30, .height = 70});
        EXPECT_EQ(found.covered, 30 * 70) << far;
    }
    const Layer layer = layer_of({{{0, 0}, {10, 5e-324}, {5, 1e-320}}});
    EXPECT_NEAR(drawn({&layer, 1}, {.width = 30, .height = 70}).covered, 0, 1e-12);
}

} // namespace
} // namespace lamella
