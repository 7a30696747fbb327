#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/jobs/voxels.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"
#include "fixtures/meshes.hpp"
#include "fixtures/random.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace lamella::voxels_cases {
namespace {

using test::Contour;
using test::expect_error;
using test::layer_of;
using test::rectangle;
using test::Triangles;

/// A plate of these bodies, each a file of its own; the last ones are negative.
Plate plate_of(std::vector<TriangleSoup> bodies, std::size_t negatives = 0) {
    std::vector<PlateInput> inputs;
    std::vector<MeshFile> files;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        inputs.push_back({.path = "body.stl", .negative = i + negatives >= bodies.size()});
        MeshFile& file = files.emplace_back();
        file.objects.push_back({"", std::move(bodies[i])});
        file.instances.emplace_back();
    }
    return load_plate(inputs, std::move(files), {});
}

/// Voxels of this size that contain the box, and a margin of one around it.
VoxelGrid around(const Box3& box, double size) {
    const auto count = [size](double from, double to) {
        return static_cast<std::uint32_t>(std::ceil((to - from) / size)) + 2;
    };
    return {.columns = count(box.min.x, box.max.x),
            .rows = count(box.min.y, box.max.y),
            .layers = count(box.min.z, box.max.z),
            .origin = {box.min.x - 0.5 * size, box.min.y - 0.5 * size, box.min.z - 0.5 * size},
            .spacing = {size, size, size}};
}

/// Returns an array for the grid, with a value that nothing writes.
template <class Value = std::uint8_t>
std::vector<Value> array_for(const VoxelGrid& grid) {
    return std::vector<Value>(static_cast<std::size_t>(grid.size()), Value{77});
}

std::vector<std::uint8_t> coverage_of(const Plate& plate, const VoxelGrid& grid, unsigned threads = 2) {
    std::vector<std::uint8_t> coverage = array_for(grid);
    EXPECT_TRUE(fill_coverage(plate, grid, coverage, {.threads = threads}).empty());
    return coverage;
}

template <class Label = std::uint8_t>
std::vector<Label> labels_of(const Plate& plate, const VoxelGrid& grid, unsigned threads = 2) {
    std::vector<Label> labels = array_for<Label>(grid);
    EXPECT_TRUE(fill_labels(plate, grid, std::span(labels), {.threads = threads}).empty());
    return labels;
}

std::vector<std::uint8_t> pixels_of_layers(const LayerStack& layers, VoxelGrid grid, PixelValue value,
                                           unsigned threads = 2) {
    grid.layers = static_cast<std::uint32_t>(layers.size());
    std::vector<std::uint8_t> pixels = array_for(grid);
    fill_pixels(source_of(std::vector<LayerStack>{layers}), grid, value, pixels, {.threads = threads});
    return pixels;
}

Plan cut_in_the_middle_of(const VoxelGrid& grid) {
    Plan plan;
    for (std::uint32_t k = 0; k < grid.layers; ++k) {
        const double z = grid.origin.z + k * grid.spacing.z;
        plan.layers.push_back({k, z, z - grid.spacing.z / 2, z + grid.spacing.z / 2});
    }
    return plan;
}

TEST(Voxels, HaveTheVolumeOfTheSlicesUpToTheRoundingOfTheirValues) {
    const Plate plate = plate_of({make_torus(6, 2, 96, 48)});
    const VoxelGrid grid = around(plate.box, 0.05);
    const std::vector<std::uint8_t> coverage = coverage_of(plate, grid);
    double voxels = 0;
    for (const std::uint8_t value : coverage)
        voxels += value / 255.0;
    double area = 0;
    for (const Layer& layer : slice(plate, cut_in_the_middle_of(grid)))
        area += measure(layer).area_mm2;
    EXPECT_NEAR(voxels * 0.05 * 0.05 / area, 1, 1e-6);
}

TEST(Voxels, AreThePixelsOfTheLayersThatAreCutInTheirMiddle) {
    const Plate plate = plate_of({make_torus(6, 2, 48, 24), make_sphere(3, 3)});
    const VoxelGrid grid = around(plate.box, 0.3);
    const LayerStack layers = slice(plate, cut_in_the_middle_of(grid));
    EXPECT_EQ(coverage_of(plate, grid), pixels_of_layers(layers, grid, PixelValue::coverage));
}

TEST(Voxels, AreTheSameForAnyNumberOfThreads) {
    const Plate plate = plate_of({make_torus(6, 2, 48, 24), make_sphere(4, 3)});
    const VoxelGrid grid = around(plate.box, 0.4);
    EXPECT_EQ(coverage_of(plate, grid, 1), coverage_of(plate, grid, 3));
    EXPECT_EQ(labels_of(plate, grid, 1), labels_of(plate, grid, 3));
    const LayerStack layers = slice(plate, cut_in_the_middle_of(grid));
    for (const PixelValue value : {PixelValue::coverage, PixelValue::inside})
        EXPECT_EQ(pixels_of_layers(layers, grid, value, 1), pixels_of_layers(layers, grid, value, 3));
}

TEST(Voxels, AreShiftedWithTheGrid) {
    const Plate plate = plate_of({make_torus(6, 2, 48, 24)});
    VoxelGrid grid = around(plate.box, 0.25); // a power of 2, so that positions are exact
    grid.origin = {-9, -9, -3};
    grid.columns = grid.rows = 72;
    grid.layers = 24;
    VoxelGrid shifted = grid;
    shifted.origin = {grid.origin.x - 3 * 0.25, grid.origin.y + 5 * 0.25, grid.origin.z - 2 * 0.25};
    const std::vector<std::uint8_t> values = coverage_of(plate, grid);
    const std::vector<std::uint8_t> others = coverage_of(plate, shifted);
    const auto at = [&](const std::vector<std::uint8_t>& array, std::size_t i, std::size_t j, std::size_t k) {
        return array[(k * grid.rows + j) * grid.columns + i];
    };
    std::size_t covered = 0;
    for (std::size_t k = 0; k + 2 < grid.layers; ++k)
        for (std::size_t j = 5; j < grid.rows; ++j)
            for (std::size_t i = 0; i + 3 < grid.columns; ++i) {
                ASSERT_EQ(at(values, i, j, k), at(others, i + 3, j - 5, k + 2)) << i << ' ' << j << ' ' << k;
                covered += at(values, i, j, k) > 0 ? 1 : 0;
            }
    EXPECT_GT(covered, 1000U);
}

TEST(Voxels, AscendWithTheCoordinates) {
    const Plate plate = plate_of({test::box_mesh({1, 2, 3}, {2, 4, 6})});
    const VoxelGrid grid{.columns = 3, .rows = 5, .layers = 7, .origin = {0.5, 0.5, 0.5}};
    const std::vector<std::uint8_t> coverage = coverage_of(plate, grid);
    for (std::uint32_t k = 0; k < 7; ++k)
        for (std::uint32_t j = 0; j < 5; ++j)
            for (std::uint32_t i = 0; i < 3; ++i)
                EXPECT_EQ(coverage[(k * 5 + j) * 3 + i],
                          i == 1 && j >= 2 && j < 4 && k >= 3 && k < 6 ? 255 : 0);
}

TEST(Voxels, AreInsideIfTheirCentreIs) {
    test::Random random(5);
    Contour ring;
    for (int i = 0; i < 40; ++i) {
        const double angle = 2 * std::acos(-1.0) * i / 40;
        const double radius = random.real(2, 9);
        ring.push_back({radius * std::cos(angle), radius * std::sin(angle)});
    }
    const VoxelGrid grid{
        .columns = 50, .rows = 60, .layers = 1, .origin = {-9, -9, 0}, .spacing = {0.37, 0.31, 1}};
    const std::vector<std::uint8_t> inside = pixels_of_layers({layer_of({ring})}, grid, PixelValue::inside);
    for (std::uint32_t j = 0; j < grid.rows; ++j)
        for (std::uint32_t i = 0; i < grid.columns; ++i) {
            const double x = grid.origin.x + i * grid.spacing.x;
            const double y = grid.origin.y + j * grid.spacing.y;
            bool in = false;
            for (std::size_t a = 0; a < ring.size(); ++a) {
                const Point2& p = ring[a];
                const Point2& q = ring[(a + 1) % ring.size()];
                if ((p.y > y) != (q.y > y) && x < p.x + (y - p.y) * (q.x - p.x) / (q.y - p.y))
                    in = !in;
            }
            ASSERT_EQ(inside[j * grid.columns + i], in ? 1 : 0) << i << ' ' << j;
        }
}

TEST(Voxels, OfBodiesThatShareAFaceShareNone) {
    const VoxelGrid grid{.columns = 8, .rows = 8, .layers = 1};
    // The common faces pass through centres.
    const std::vector<Layer> quarters{layer_of({rectangle(0, 0, 3, 4)}), layer_of({rectangle(3, 0, 7, 4)}),
                                      layer_of({rectangle(0, 4, 3, 7)}), layer_of({rectangle(3, 4, 7, 7)})};
    std::vector<int> sum(64);
    for (const Layer& quarter : quarters) {
        const std::vector<std::uint8_t> inside = pixels_of_layers({quarter}, grid, PixelValue::inside);
        for (std::size_t i = 0; i < sum.size(); ++i)
            sum[i] += inside[i];
    }
    EXPECT_EQ(std::count(sum.begin(), sum.end(), 1), 49);
    EXPECT_EQ(std::count(sum.begin(), sum.end(), 0), 64 - 49);
}

TEST(Voxels, OfAdjacentPartsHaveTheNumberOfThePartWithTheLargerShare) {
    // The common wall is at x = 2.6: of the voxel from 2 to 3 the first has the larger share.
    const Plate plate = plate_of({test::box_mesh({0, 0, 0}, {2.6F, 2, 1}),
                                  test::box_mesh({2.6F, 0, 0}, {5, 2, 1}), make_box(1, 1, 1)});
    const VoxelGrid grid{.columns = 6, .rows = 2, .layers = 2, .origin = {0.5, 0.5, 0.5}};
    const std::vector<std::uint8_t> expected{1, 1, 1, 2, 2, 0, 1, 1, 1, 2, 2, 0};
    std::vector<std::uint8_t> labels = labels_of(plate, grid);
    EXPECT_EQ(std::vector(labels.begin(), labels.begin() + 12), expected);
    EXPECT_EQ(std::count(labels.begin() + 12, labels.end(), 0), 12);
    const std::vector<std::uint16_t> wide = labels_of<std::uint16_t>(plate, grid);
    EXPECT_TRUE(std::equal(labels.begin(), labels.end(), wide.begin(), wide.end()));
}

TEST(Voxels, OfOverlappingPartsHaveTheNumberOfTheFirst) {
    const Plate plate =
        plate_of({test::box_mesh({0, 0, 0}, {3, 1, 1}), test::box_mesh({2, 0, 0}, {5, 1, 1})});
    const VoxelGrid grid{.columns = 5, .rows = 1, .layers = 1, .origin = {0.5, 0.5, 0.5}};
    EXPECT_EQ(labels_of(plate, grid), (std::vector<std::uint8_t>{1, 1, 1, 2, 2}));
}

TEST(Voxels, BelongToAPartOnlyIfMaterialTakesHalfOfThem) {
    // Each takes 0.3 of the first voxel, together 0.6; they cover the same 0.3 of the second one.
    const Plate plate =
        plate_of({TriangleSoup(test::joined({test::box_triangles({0, 0, 0}, {0.3F, 1, 1}),
                                             test::box_triangles({1, 0, 0}, {1.3F, 1, 1})})),
                  TriangleSoup(test::joined({test::box_triangles({0.5F, 0, 0}, {0.875F, 1, 1}),
                                             test::box_triangles({1, 0, 0}, {1.3F, 1, 1})}))});
    const VoxelGrid grid{.columns = 2, .rows = 1, .layers = 1, .origin = {0.5, 0.5, 0.5}};
    EXPECT_EQ(labels_of(plate, grid), (std::vector<std::uint8_t>{2, 0}));
    const Plate half = plate_of({test::box_mesh({0, 0, 0}, {1.5F, 1, 1})});
    EXPECT_EQ(labels_of(half, grid), (std::vector<std::uint8_t>{1, 1}));
}

TEST(Voxels, OfNegativeVolumesAreEmpty) {
    const Plate plate = plate_of({make_box(4, 4, 4), test::box_mesh({1, 1, 1}, {3, 3, 3})}, 1);
    const VoxelGrid grid{.columns = 4, .rows = 4, .layers = 4, .origin = {0.5, 0.5, 0.5}};
    const std::vector<std::uint8_t> labels = labels_of(plate, grid);
    EXPECT_EQ(std::accumulate(labels.begin(), labels.end(), 0), 64 - 8);
}

TEST(Voxels, ReportTheDefectsOfEachFile) {
    Triangles open = test::box_triangles({0, 0, 0}, {2, 2, 2});
    open.resize(open.size() - 2); // without one of its walls
    const Plate plate = plate_of({test::box_mesh({4, 0, 0}, {6, 2, 2}), TriangleSoup(open)});
    const VoxelGrid grid = around(plate.box, 0.5);
    std::vector<std::uint8_t> labels = array_for(grid);
    const Findings findings = fill_labels(plate, grid, std::span(labels));
    EXPECT_EQ(findings.of(FindingKind::open_chains, 0).count, 0U);
    EXPECT_EQ(findings.of(FindingKind::open_chains, 1).count, 4U);
    EXPECT_EQ(findings.of(FindingKind::open_chains, 1).of_layers, grid.layers);
}

TEST(Voxels, OfAHoleWhoseOuterContourIsOpenAreEmpty) {
    const Layer layer = layer_of({test::reversed(rectangle(1, 1, 3, 3))}, {{{0, 0}, {4, 0}, {4, 4}, {0, 4}}});
    const VoxelGrid grid{.columns = 4, .rows = 4, .layers = 1, .origin = {0.5, 0.5, 0}};
    for (const PixelValue value : {PixelValue::coverage, PixelValue::inside}) {
        const std::vector<std::uint8_t> pixels = pixels_of_layers({layer}, grid, value);
        EXPECT_EQ(std::count(pixels.begin(), pixels.end(), 0), 16);
    }
}

TEST(Voxels, ThatAreImpossibleAreErrors) {
    const VoxelGrid grid{.columns = 5, .rows = 4, .layers = 3};
    check(grid, 1, 60);
    expect_error(ErrorKind::limit, {"5 x 4 x 3", "60 bytes", "59 bytes", "`max_memory`"},
                 [&] { check(grid, 1, 59); });
    expect_error(ErrorKind::limit, {"120 bytes"}, [&] { check(grid, 2, 119); });
    const auto refused = [&](auto change, std::initializer_list<const char*> parts) {
        VoxelGrid wrong = grid;
        change(wrong);
        expect_error(ErrorKind::usage, parts, [&] { check(wrong, 1); });
        std::vector<std::uint8_t> array = array_for(grid);
        expect_error(ErrorKind::usage, {},
                     [&] { fill_coverage(plate_of({make_box(1, 1, 1)}), wrong, array); });
    };
    refused([](VoxelGrid& g) { g.columns = 0; }, {"0 x 4 x 3"});
    refused([](VoxelGrid& g) { g.rows = 65536; }, {"65535"});
    refused([](VoxelGrid& g) { g.layers = 0x7fffffff; }, {"along z"});
    refused([](VoxelGrid& g) { g.spacing.y = 0; }, {"above 0"});
    refused([](VoxelGrid& g) { g.spacing.x = -1; }, {"above 0"});
    refused([](VoxelGrid& g) { g.spacing.z = std::numeric_limits<double>::quiet_NaN(); }, {"finite"});
    refused([](VoxelGrid& g) { g.origin.x = std::numeric_limits<double>::infinity(); }, {"finite"});
    refused([](VoxelGrid& g) { g.origin.z = 1e17; }, {"too low for double precision"});
    refused([](VoxelGrid& g) { g.origin.z = -1e17; }, {"too low for double precision"});

    std::vector<std::uint8_t> short_array(59);
    expect_error(ErrorKind::usage, {"59 numbers"},
                 [&] { fill_coverage(plate_of({make_box(1, 1, 1)}), grid, short_array); });
    std::vector<std::uint8_t> array(60);
    expect_error(ErrorKind::usage, {"1 planes"}, [&] {
        fill_pixels(source_of(std::vector<LayerStack>{{Layer()}}), grid, PixelValue::inside, array);
    });
    expect_error(ErrorKind::usage, {"256 parts", "255"}, [&] {
        fill_labels(plate_of(std::vector<TriangleSoup>(256, make_box(1, 1, 1))), grid, std::span(array));
    });
    expect_error(ErrorKind::limit, {},
                 [] { check({.columns = 65535, .rows = 65535, .layers = 0x7ffffffe}, 2); });
}

TEST(Voxels, StopOnRequest) {
    const Plate plate = plate_of({make_sphere(5, 3)});
    const VoxelGrid grid = around(plate.box, 0.05);
    std::vector<std::uint8_t> array = array_for(grid);
    CancelFlag cancel;
    cancel.request();
    const Execution execution{.threads = 2, .cancel = &cancel};
    expect_error(ErrorKind::cancelled, {}, [&] { fill_coverage(plate, grid, array, execution); });
    expect_error(ErrorKind::cancelled, {}, [&] { fill_labels(plate, grid, std::span(array), execution); });
    const PlaneSource source = source_of(std::vector<LayerStack>{LayerStack(grid.layers)});
    expect_error(ErrorKind::cancelled, {},
                 [&] { fill_pixels(source, grid, PixelValue::coverage, array, execution); });
}

} // namespace
} // namespace lamella::voxels_cases
