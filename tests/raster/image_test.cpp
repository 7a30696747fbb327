#include "lamella/contour/measure.hpp"
#include "lamella/raster/image.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/random.hpp"
#include "raster/clipped_area.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

namespace lamella {
namespace {

using test::Contour;
using test::diamond;
using test::layer_of;
using test::Random;
using test::rectangle;
using test::reversed;

/// Picture coordinates are those of the layer.
PixelGrid plain(std::uint32_t width, std::uint32_t height) {
    return {.width = width, .height = height};
}

GreyImage paint_one(const Layer& layer, const PixelGrid& grid, unsigned antialias) {
    return paint({&layer, 1}, grid, {.antialias = antialias});
}

auto pixels_of(int value, const GreyImage& image) {
    return std::count(image.values.begin(), image.values.end(), value);
}

Contour star(Random& random, const Point2& middle, double least, double most, int points) {
    Contour ring;
    for (int i = 0; i < points; ++i) {
        const double angle = 2 * std::numbers::pi * i / points;
        const double radius = random.real(least, most);
        ring.push_back({middle.x + radius * std::cos(angle), middle.y + radius * std::sin(angle)});
    }
    return ring;
}

/// Rings of any shape and either direction, across one another and across the border of the picture.
Layer tangle(std::uint64_t seed, double size) {
    Random random(seed);
    std::vector<Contour> rings;
    const auto count = random.integer(1, 6);
    for (std::int64_t r = 0; r < count; ++r) {
        Contour ring;
        const auto points = random.integer(3, 9);
        for (std::int64_t i = 0; i < points; ++i)
            ring.push_back({random.real(-0.3, 1.3) * size, random.real(-0.3, 1.3) * size});
        rings.push_back(std::move(ring));
    }
    return layer_of(rings);
}

/// How often the rings run around a place, by the side of each edge on which it lies. A place on an edge
/// counts as being to its right.
int winding_number(const Layer& layer, const Point2& at) {
    int winding = 0;
    for (std::size_t r = 0; r < layer.rings; ++r) {
        const auto ring = layer.contour(r);
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Point2& p = ring[i];
            const Point2& q = ring[(i + 1) % ring.size()];
            const auto side = [&](const Point2& from, const Point2& to) { // of the line downwards
                const auto along_x = static_cast<long double>(to.x) - from.x;
                const auto along_y = static_cast<long double>(to.y) - from.y;
                return along_x * (at.y - from.y) - along_y * (at.x - from.x);
            };
            if (p.y <= at.y && at.y < q.y && side(p, q) <= 0)
                ++winding;
            else if (q.y <= at.y && at.y < p.y && side(q, p) <= 0)
                --winding;
        }
    }
    return winding;
}

/// The part of a pixel where the winding number is not zero, from many places in it.
double sampled(const Layer& layer, std::uint32_t column, std::uint32_t row, int samples) {
    int inside = 0;
    for (int i = 0; i < samples; ++i)
        for (int j = 0; j < samples; ++j)
            inside += winding_number(layer, {column + (j + 0.5) / samples, row + (i + 0.5) / samples}) != 0;
    return inside / static_cast<double>(samples * samples);
}

/// A counter-clockwise one.
Contour triangle(Random& random, double from, double to) {
    Contour ring;
    for (int i = 0; i < 3; ++i)
        ring.push_back({random.real(from, to), random.real(from, to)});
    if (ring_area(ring) < 0)
        std::swap(ring[1], ring[2]);
    return ring;
}

/// Compares all pixels: covered(column, row) is how much of one is.
template <class Covered>
void expect_covered(const GreyImage& image, std::uint64_t seed, const Covered& covered) {
    for (std::uint32_t r = 0; r < image.height; ++r)
        for (std::uint32_t c = 0; c < image.width; ++c)
            ASSERT_NEAR(image.row(r)[c], 255 * covered(c, r), 0.5 + 1e-6)
                << "seed " << seed << ", column " << c << ", row " << r;
}

void expect_centres(const GreyImage& image, std::uint64_t seed, const Layer& layer) {
    expect_covered(image, seed, [&](double column, double row) {
        return winding_number(layer, {column + 0.5, row + 0.5}) != 0 ? 1 : 0;
    });
}

/// What two convex rings that run counter-clockwise have in common.
Contour common(Contour ring, const Contour& other) {
    for (std::size_t i = 0; i < other.size(); ++i) {
        const Point2& from = other[i];
        const Point2& to = other[(i + 1) % other.size()];
        ring = test::cut_off(ring, [&](const Point2& p) {
            return (to.x - from.x) * (p.y - from.y) - (to.y - from.y) * (p.x - from.x);
        });
    }
    return ring;
}

TEST(Image, WithoutAntiAliasingHasThePixelsWhoseCentresAreInside) {
    constexpr std::uint32_t size = 24;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        const Layer layer = tangle(seed, size);
        expect_centres(paint_one(layer, plain(size, size), 1), seed, layer);
    }
}

TEST(Image, GivesCentresOnContoursToOneOfTwoNeighbours) {
    // Corners on centres and on the lines between pixels: all of it is exact here.
    constexpr std::uint32_t size = 16;
    for (std::uint64_t seed = 0; seed < 300; ++seed) {
        Random random(seed);
        std::vector<Contour> rings;
        for (int r = 0; r < 3; ++r) {
            const Point2 a{static_cast<double>(random.integer(-4, 36)) / 2,
                           static_cast<double>(random.integer(-4, 36)) / 2};
            const double side = static_cast<double>(random.integer(1, 16)) / 2;
            rings.push_back(random.integer(0, 1) == 0 ? rectangle(a.x, a.y, a.x + side, a.y + side)
                                                      : diamond(a.x, a.y, side));
        }
        const Layer layer = layer_of(rings);
        expect_centres(paint_one(layer, plain(size, size), 1), seed, layer);
    }
}

TEST(Image, CoversEachPixelAsManySamplesOfItSay) {
    constexpr std::uint32_t size = 12;
    constexpr int samples = 48;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        const Layer layer = tangle(1000 + seed, size);
        std::vector<double> expected;
        for (std::uint32_t r = 0; r < size; ++r)
            for (std::uint32_t c = 0; c < size; ++c)
                expected.push_back(255 * sampled(layer, c, r, samples));
        for (const unsigned antialias : {2U, 3U, 4U, 8U, 16U, 64U}) {
            const GreyImage image = paint_one(layer, plain(size, size), antialias);
            double sum = 0;
            for (std::size_t i = 0; i < expected.size(); ++i) {
                const double difference = std::abs(image.values[i] - expected[i]);
                sum += difference;
                // Corners and crossings fall into a few strips of a pixel; samples have an error of their
                // own.
                ASSERT_LE(difference, 255 * (2.5 / antialias + 1.5 / samples))
                    << "seed " << seed << ", antialias " << antialias << ", pixel " << i;
            }
            ASSERT_LE(sum / static_cast<double>(expected.size()), 255 * (0.1 / antialias + 0.1 / samples))
                << "seed " << seed << ", antialias " << antialias;
        }
    }
}

TEST(Image, IsExactWhereNoCornerLiesInTheRow) {
    constexpr std::uint32_t size = 20;
    std::size_t checked = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Random random(seed);
        const Contour ring = random.integer(0, 1) == 0
                                 ? Contour{{random.real(-9, 29), random.real(-9, 29)},
                                           {random.real(-9, 29), random.real(-9, 29)},
                                           {random.real(-9, 29), random.real(-9, 29)}}
                                 : diamond(random.real(5, 15), random.real(5, 15), random.real(1, 15));
        const GreyImage image = paint_one(layer_of({ring}), plain(size, size), 2);
        for (std::uint32_t r = 0; r < size; ++r) {
            if (std::any_of(ring.begin(), ring.end(),
                            [r](const Point2& p) { return p.y > r && p.y < r + 1; }))
                continue;
            for (std::uint32_t c = 0; c < size; ++c) {
                ASSERT_NEAR(image.row(r)[c], 255 * test::clipped_area(ring, c, r), 0.5 + 1e-6)
                    << "seed " << seed << ", column " << c << ", row " << r;
                ++checked;
            }
        }
    }
    EXPECT_GT(checked, 50000U);
}

TEST(Image, IsExactWithCornersAnywhere) {
    constexpr std::uint32_t size = 16;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Random random(seed);
        Contour ring =
            seed % 2 == 0 ? triangle(random, -5, 21) : triangle(random, 4, 7); // within a few pixels
        if (seed % 3 == 0)
            ring[0].y = ring[1].y; // a level side, within a row
        expect_covered(paint_one(layer_of({ring}), plain(size, size), 4), seed,
                       [&](double c, double r) { return test::clipped_area(ring, c, r); });
    }
}

TEST(Image, IsExactAlongLinesOfAnyNumberOfEdges) {
    // Dozens of corners of rim and hole in each row.
    constexpr std::uint32_t size = 40;
    for (std::uint64_t seed = 0; seed < 4; ++seed) {
        Random random(seed);
        const Point2 middle{random.real(19, 21), random.real(19, 21)};
        const Contour rim = star(random, middle, 17, 17.0000001, 6000);
        const Contour hole = reversed(star(random, middle, 9, 9.0000001, 3000));
        const Layer layer = layer_of({rim, hole});
        const GreyImage image = paint_one(layer, plain(size, size), 2);
        for (std::uint32_t r = 0; r < size; ++r) {
            const double off = std::abs(r + 0.5 - middle.y);
            if (off > 7 && off < 19)
                continue; // tops and bottoms, which are cut into strips
            for (std::uint32_t c = 0; c < size; ++c)
                ASSERT_NEAR(image.row(r)[c],
                            255 * (test::clipped_area(rim, c, r) - test::clipped_area(hole, c, r)),
                            0.5 + 1e-6)
                    << "seed " << seed << ", column " << c << ", row " << r;
        }
    }
}

TEST(Image, IsExactAlongLinesWithStepsBackAndForth) {
    constexpr std::uint32_t size = 12;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        // Falls row by row, by many corners to the left and right, some of them on one height.
        Contour ring;
        double y = random.real(-1, 1);
        while (y < size) {
            ring.push_back({random.real(3, 5), y});
            y += random.integer(0, 3) == 0 ? 0 : random.real(0, 0.2);
        }
        const Contour line = ring;
        ring.push_back({11, y});
        ring.push_back({11, line.front().y});
        const Layer layer = layer_of({ring});
        const GreyImage image = paint_one(layer, plain(size, size), 2);
        for (std::uint32_t r = 2; r + 1 < size; ++r) { // the line goes through the whole row
            for (std::uint32_t c = 0; c < size; ++c) {
                double covered = 0; // trapezoids from the line to the right
                for (std::size_t i = 0; i + 1 < line.size(); ++i)
                    covered += test::clipped_area(
                        {line[i], line[i + 1], {11, line[i + 1].y}, {11, line[i].y}}, c, r);
                ASSERT_NEAR(image.row(r)[c], 255 * covered, 0.5 + 1e-6)
                    << "seed " << seed << ", column " << c << ", row " << r;
            }
        }
    }
}

TEST(Image, IsExactWhereBodiesOverlap) {
    constexpr std::uint32_t size = 16;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Random random(seed);
        const Contour a = triangle(random, -5, 21);
        const Contour b = triangle(random, -5, 21);
        const Contour both = common(a, b);
        const std::vector<Layer> parts{layer_of({a}), layer_of({b})};
        expect_covered(paint(parts, plain(size, size), {.antialias = 16}), seed, [&](double c, double r) {
            return test::clipped_area(a, c, r) + test::clipped_area(b, c, r) - test::clipped_area(both, c, r);
        });
    }
}

TEST(Image, IsExactForSidesAlongThePixels) {
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        Random random(seed);
        const double x = random.real(-2, 10);
        const double y = random.real(-2, 10);
        const Contour ring = rectangle(x, y, x + random.real(1, 12), y + random.real(0.01, 12));
        for (const unsigned antialias : {2U, 8U})
            expect_covered(paint_one(layer_of({ring}), plain(16, 16), antialias), seed,
                           [&](double c, double r) { return test::clipped_area(ring, c, r); });
    }
}

TEST(Image, HasTheAreaOfTheLayer) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        Random random(seed);
        const double mm = random.real(0.02, 0.1); // of a pixel
        std::vector<Contour> rings{star(random, {10, 10}, 5, 9, 40),
                                   reversed(star(random, {10, 10}, 1, 4, 30))};
        const Layer layer = layer_of(rings);
        const PixelGrid grid{.width = 1000, .height = 1000, .ux = 1 / mm, .vy = -1 / mm, .v0 = 1000};
        const LayerMeasure measured = measure(layer);
        for (const unsigned antialias : {1U, 4U, 16U}) {
            const double pixels =
                rasterise({&layer, 1}, grid, {.antialias = antialias}, [](auto, auto) {}).covered;
            const double bound = antialias == 1 ? 0.05 * measured.perimeter_mm * mm : 1e-9;
            EXPECT_NEAR(pixels * mm * mm, measured.area_mm2, bound)
                << "seed " << seed << ", antialias " << antialias;
        }
    }
}

TEST(Image, SumsUpToTheCoverageThatItReports) {
    const Layer layer = tangle(77, 200);
    const PixelGrid grid = plain(200, 200);
    const double covered = rasterise({&layer, 1}, grid, {.antialias = 8}, [](auto, auto) {}).covered;
    double sum = 0;
    for (const std::uint8_t value : paint_one(layer, grid, 8).values)
        sum += value / 255.0;
    EXPECT_GT(covered, 1000);
    EXPECT_NEAR(sum, covered, 200 * 200 * 0.5 / 255 * 0.1);
}

TEST(Image, ShowsTheSameOfALayerWhereverItsBordersLie) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        const Layer layer = tangle(seed, 60);
        PixelGrid large{.width = 160, .height = 160, .u0 = 50, .v0 = 50};
        for (const unsigned antialias : {1U, 64U}) {
            const GreyImage whole = paint_one(layer, large, antialias);
            PixelGrid small{.width = 37, .height = 21, .u0 = -11, .v0 = -23};
            const GreyImage part = paint_one(layer, small, antialias);
            for (std::uint32_t r = 0; r < small.height; ++r)
                for (std::uint32_t c = 0; c < small.width; ++c)
                    ASSERT_NEAR(part.row(r)[c], whole.row(r + 73)[c + 61], 1)
                        << "seed " << seed << ", column " << c << ", row " << r;
        }
    }
}

TEST(Image, MapsPointsAsTheGridSays) {
    // A dot in the corner of +x and +y, on each of the eight ways to hold a picture.
    const Layer layer = layer_of({rectangle(9, 7, 10, 8)});
    struct Way {
        PixelGrid grid;
        std::uint32_t column;
        std::uint32_t row;
    };
    const std::vector<Way> ways{
        {{10, 8, 1, 0, 0, 0, 1, 0}, 9, 7},   {{10, 8, -1, 0, 10, 0, 1, 0}, 0, 7},
        {{10, 8, 1, 0, 0, 0, -1, 8}, 9, 0},  {{10, 8, -1, 0, 10, 0, -1, 8}, 0, 0},
        {{8, 10, 0, 1, 0, 1, 0, 0}, 7, 9},   {{8, 10, 0, -1, 8, 1, 0, 0}, 0, 9},
        {{8, 10, 0, 1, 0, -1, 0, 10}, 7, 0}, {{8, 10, 0, -1, 8, -1, 0, 10}, 0, 0},
    };
    for (const Way& way : ways) {
        for (const unsigned antialias : {1U, 4U}) {
            const GreyImage image = paint_one(layer, way.grid, antialias);
            for (std::uint32_t r = 0; r < image.height; ++r)
                for (std::uint32_t c = 0; c < image.width; ++c)
                    EXPECT_EQ(image.row(r)[c], c == way.column && r == way.row ? 255 : 0);
        }
    }
}

TEST(Image, CoversOnceWhatSeveralBodiesCover) {
    Random random(5);
    const Contour body = star(random, {50, 50}, 20, 45, 30);
    const Contour inside = star(random, {50, 50}, 5, 15, 12);
    for (const unsigned antialias : {1U, 4U, 16U}) {
        const GreyImage once = paint_one(layer_of({body}), plain(100, 100), antialias);
        EXPECT_EQ(paint_one(layer_of({body, body}), plain(100, 100), antialias).values, once.values);
        EXPECT_EQ(paint_one(layer_of({body, inside}), plain(100, 100), antialias).values, once.values);
        const std::vector<Layer> parts{layer_of({body}), layer_of({inside}), layer_of({body})};
        EXPECT_EQ(paint(parts, plain(100, 100), {.antialias = antialias}).values, once.values);
    }
}

TEST(Image, LeavesHolesOpenAndFillsWhatLiesInThem) {
    const Contour hole = reversed(rectangle(10, 10, 90, 90));
    for (const unsigned antialias : {1U, 4U}) {
        const GreyImage image =
            paint_one(layer_of({rectangle(0, 0, 100, 100), hole, rectangle(40, 40, 60, 60)}), plain(100, 100),
                      antialias);
        for (std::uint32_t r = 0; r < 100; ++r)
            for (std::uint32_t c = 0; c < 100; ++c) {
                const auto within = [&](std::uint32_t from, std::uint32_t to) {
                    return r >= from && r < to && c >= from && c < to;
                };
                ASSERT_EQ(image.row(r)[c], within(40, 60) || !within(10, 90) ? 255 : 0);
            }
        // Filled by another part, there is no hole.
        const std::vector<Layer> parts{layer_of({rectangle(0, 0, 100, 100), hole}),
                                       layer_of({rectangle(10, 10, 90, 90)})};
        const GreyImage filled = paint(parts, plain(100, 100), {.antialias = antialias});
        EXPECT_EQ(pixels_of(255, filled), 100 * 100);
    }
}

TEST(Image, HasNoSeamWhereBodiesTouch) {
    // A square in two halves with a slanted border; one of them has a corner on it that the other lacks.
    for (std::uint64_t seed = 0; seed < 200; ++seed) {
        Random random(seed);
        const Point2 top{random.real(5, 95), 0};
        const Point2 bottom{random.real(5, 95), 100};
        const double t = random.real(0.1, 0.9);
        const Point2 between{top.x + t * (bottom.x - top.x), 100 * t};
        const Layer layer =
            layer_of({{{0, 0}, top, between, bottom, {0, 100}}, {{100, 0}, {100, 100}, bottom, top}});
        for (const unsigned antialias : {2U, 4U, 16U})
            ASSERT_EQ(pixels_of(255, paint_one(layer, plain(100, 100), antialias)), 100 * 100)
                << "seed " << seed << ", antialias " << antialias;
    }
}

TEST(Image, IgnoresOpenChains) {
    const Layer layer = layer_of({rectangle(2, 2, 5, 5)}, {{{0, 0}, {9, 0}, {9, 9}}});
    const GreyImage image = paint_one(layer, plain(10, 10), 4);
    EXPECT_EQ(pixels_of(255, image), 9);
    EXPECT_EQ(pixels_of(0, image), 91);
}

double unseen_of(const Layer& layer, unsigned antialias, bool winds_once = false) {
    return rasterise({&layer, 1}, plain(100, 100), {.antialias = antialias, .winds_once = winds_once},
                     [](auto, auto) {})
        .unseen;
}

Contour transposed(Contour ring) {
    for (Point2& p : ring)
        p = {p.y, p.x};
    return reversed(ring);
}

TEST(Image, MeasuresMaterialThatIsTooThinForItsPixels) {
    const Contour body = rectangle(10, 10, 60, 60);
    const Contour beside = rectangle(70.55, 10, 70.95, 60);
    const Contour fin{{10, 10},    {60, 10},    {60, 60},    {40.95, 60},
                      {40.95, 90}, {40.55, 90}, {40.55, 60}, {10, 60}};
    for (const bool turned : {false, true}) {
        const auto layer = [&](const std::vector<Contour>& rings) {
            std::vector<Contour> all;
            for (const Contour& ring : rings)
                all.push_back(turned ? transposed(ring) : ring);
            return layer_of(all);
        };
        EXPECT_EQ(unseen_of(layer({body}), 1), 0);
        EXPECT_NEAR(unseen_of(layer({body, beside}), 1), 20, 1e-9);
        EXPECT_NEAR(unseen_of(layer({fin}), 1), 12, 1);
        for (const bool once : {false, true}) {
            EXPECT_EQ(unseen_of(layer({fin}), 8, once), 0);
            EXPECT_NEAR(unseen_of(layer({body, rectangle(70.5, 10, 70.5 + 1. / 600, 60)}), 8, once),
                        50. / 600, 1e-9);
            EXPECT_EQ(unseen_of(layer({body, rectangle(70.5, 10, 70.5 + 1. / 400, 60)}), 8, once), 0);
        }
    }
}

TEST(Image, ShowsLargerBodiesWhole) {
    Random random(77);
    for (int round = 0; round < 300; ++round) {
        Contour ring;
        const int corners = static_cast<int>(random.integer(3, 60));
        const double radius = random.real(6, 40);
        const double turn = random.real(0, 7);
        for (int i = 0; i < corners; ++i) {
            const double angle = turn + 2 * std::numbers::pi * i / corners;
            ring.push_back({50 + radius * std::cos(angle), 50 + radius * std::sin(angle)});
        }
        for (const unsigned antialias : {1U, 4U})
            EXPECT_LE(unseen_of(layer_of({ring}), antialias), 1) << round;
    }
}

TEST(Image, IsBlankWithoutMaterial) {
    for (const Layer& layer :
         {Layer{}, layer_of({rectangle(200, 0, 300, 10)}), layer_of({rectangle(-30, 0, -20, 10)}),
          layer_of({rectangle(0, 40, 10, 50)}), layer_of({rectangle(0, -40, 10, -30)})}) {
        std::uint32_t rows = 0;
        const RasterAreas areas = rasterise({&layer, 1}, plain(100, 20), {}, [&](auto row, auto times) {
            ASSERT_EQ(row.size(), 1U);
            EXPECT_EQ(row.front(), (PixelRun{100, 0}));
            rows += times;
        });
        EXPECT_EQ(rows, 20U);
        EXPECT_EQ(areas.covered, 0);
    }
}

TEST(Image, TakesRowsThatAreTheSameTogether) {
    const Layer layer = layer_of({rectangle(10, 100, 90, 900)});
    std::vector<std::uint32_t> times;
    rasterise({&layer, 1}, plain(100, 1000), {}, [&](auto, std::uint32_t n) { times.push_back(n); });
    EXPECT_EQ(times, (std::vector<std::uint32_t>{100, 800, 100}));
}

TEST(Image, CountsEveryRowAndPixelOnce) {
    for (std::uint64_t seed = 0; seed < 100; ++seed) {
        const Layer layer = tangle(seed, 100);
        std::uint64_t rows = 0;
        rasterise({&layer, 1}, plain(90, 110), {.antialias = 3}, [&](auto row, std::uint32_t times) {
            ASSERT_GT(times, 0U);
            ASSERT_EQ(row.back().end, 90U);
            ASSERT_GT(row.front().end, 0U);
            for (std::size_t i = 1; i < row.size(); ++i) {
                ASSERT_LT(row[i - 1].end, row[i].end);
                ASSERT_NE(row[i - 1].value, row[i].value);
            }
            rows += times;
        });
        ASSERT_EQ(rows, 110U);
    }
}

TEST(Image, StandsThousandsOfEdgesThatCrossEachOther) {
    Random random(3);
    Contour ring;
    for (int i = 0; i < 4000; ++i)
        ring.push_back({random.real(-20, 120), random.real(-20, 120)});
    const Layer layer = layer_of({ring});
    const GreyImage image = paint_one(layer, plain(100, 100), 1);
    for (std::uint32_t r = 0; r < 100; r += 7)
        for (std::uint32_t c = 0; c < 100; c += 7)
            ASSERT_EQ(image.row(r)[c], winding_number(layer, {c + 0.5, r + 0.5}) != 0 ? 255 : 0);
}

TEST(Image, StandsCoordinatesAtTheEndOfTheNumbers) {
    constexpr double most = std::numeric_limits<double>::max();
    const Layer around = layer_of({rectangle(-most, -most, most, most)});
    for (const unsigned antialias : {1U, 4U}) {
        const GreyImage image = paint_one(around, plain(50, 50), antialias);
        EXPECT_EQ(pixels_of(255, image), 50 * 50);
        const PixelGrid turned{.width = 9, .height = 9, .ux = 1e9, .uy = 1e9, .vx = 1e9, .vy = -1e9};
        EXPECT_EQ(paint_one(around, turned, antialias).values.size(), 81U);
    }
    // Slopes from one side of the numbers to the other.
    const Layer needle = layer_of({{{-most, 10}, {most, 10.5}, {most, 10.6}}});
    EXPECT_EQ(paint_one(needle, plain(50, 50), 4).values.size(), 2500U);
    const Layer speck = layer_of({{{5e-324, 0.5}, {1e-300, 0.5}, {2e-308, std::nextafter(0.5, 1)}}});
    EXPECT_EQ(pixels_of(0, paint_one(speck, plain(50, 50), 1)), 2500);
}

TEST(Image, ReachesTheLargestSize) {
    const Layer layer = layer_of({{{0, 0}, {most_pixels, 0}, {most_pixels, most_pixels}}});
    const double half = 0.5 * most_pixels * most_pixels;
    EXPECT_NEAR(rasterise({&layer, 1}, plain(most_pixels, most_pixels), {}, [](auto, auto) {}).covered, half,
                1);
}

TEST(Image, BendsValuesByGammaAndLeavesFullAndEmptyPixels) {
    const Layer layer = layer_of({rectangle(1, 1, 3.25, 3)});
    const GreyImage image = paint({&layer, 1}, plain(5, 5), {.antialias = 4, .gamma = 2});
    EXPECT_EQ(image.row(1)[0], 0);
    EXPECT_EQ(image.row(1)[1], 255);
    EXPECT_EQ(image.row(1)[3], std::lround(255 * (64 / 255.0) * (64 / 255.0)));
}

TEST(Image, RefusesWhatMakesNoImage) {
    const auto message = [](const PixelGrid& grid, const RasterOptions& options) {
        return test::error_of(ErrorKind::usage, [&] { static_cast<void>(paint({}, grid, options)); });
    };
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(message(plain(0, 10), {}).find("0 x 10 pixels: each side must have 1 to 65535"),
              std::string::npos);
    EXPECT_NE(message(plain(10, 65536), {}).find("10 x 65536"), std::string::npos);
    EXPECT_NE(message({.width = 1, .height = 1, .ux = 0}, {}).find("not zero"), std::string::npos);
    EXPECT_NE(message({.width = 1, .height = 1, .ux = nan}, {}).find("finite"), std::string::npos);
    EXPECT_NE(message({.width = 1, .height = 1, .u0 = nan}, {}).find("finite"), std::string::npos);
    EXPECT_NE(message(plain(1, 1), {.antialias = 0}).find("choose 1 (none) to 64"), std::string::npos);
    EXPECT_NE(message(plain(1, 1), {.antialias = 65}).find("level 65"), std::string::npos);
    EXPECT_NE(message(plain(1, 1), {.gamma = 0}).find("gamma of 0"), std::string::npos);
    EXPECT_NE(message(plain(1, 1), {.gamma = nan}).find("gamma of nan"), std::string::npos);
    EXPECT_NO_THROW(static_cast<void>(paint({}, plain(1, 1), {})));
}

} // namespace
} // namespace lamella
