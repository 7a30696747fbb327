#include "lamella/jobs/slice_file.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/slicing/varying_plan.hpp"

#include "jobs/material_surface.hpp"
#include "jobs/plate_builder.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lamella::material_surface_cases {
namespace {

constexpr AdaptiveLayers adaptive{.min_height = 0.1, .max_height = 1, .cusp_mm = 0.1};

/// An object of boxes 20 mm wide with a negative volume, and a box of 30 mm height beside it, all from one
/// file.
Plate plate_with(const TriangleSoup& negative, const Transform& where, double height = 10) {
    MeshFile file;
    file.objects = {{"block", make_box(20, 20, height)}, {"hole", negative}, {"beside", make_box(5, 5, 30)}};
    file.instances = {{.object = 0, .body = 0},
                      {.object = 1, .placement = where, .negative = true, .body = 0},
                      {.object = 2, .placement = translation(40, 0, 0), .body = 1}};
    std::vector<MeshFile> files;
    files.push_back(std::move(file));
    return load_plate(std::vector<PlateInput>{{.path = "a.3mf"}}, std::move(files), {});
}

std::vector<double> tops(const Plate& plate) {
    FileJob job;
    job.inputs = {{.path = "a.3mf"}};
    job.layering.cut = adaptive;
    std::vector<double> heights;
    for (const PlannedLayer& layer : plan_of(job, plate).layers)
        heights.push_back(layer.top);
    return heights;
}

std::vector<double> tops_without_negatives() {
    Plate plate = plate_with(make_sphere(3, 3), translation(10, 10, 5));
    plate.negatives.clear();
    return tops(plate);
}

/// Returns the number of layers whose tops lie between these heights.
std::size_t layers_within(std::span<const double> heights, double from, double to) {
    return static_cast<std::size_t>(
        std::count_if(heights.begin(), heights.end(), [&](double z) { return from < z && z <= to; }));
}

TEST(MaterialSurface, GivesNegativeVolumesInsideOfMaterialLayersAsFineAsTheirSlopes) {
    const TriangleSoup ball = make_sphere(3, 3);
    const std::vector<double> with = tops(plate_with(ball, translation(10, 10, 5)));
    EXPECT_EQ(layers_within(with, 0, 1), 1U);
    EXPECT_GT(layers_within(with, 2, 8), 20U);
    EXPECT_LT(layers_within(with, 11, 30), 22U);
    EXPECT_EQ(with.back(), 30);
    // They are the layers of a block with a hollow.
    const TriangleSoup hollow = ball.transformed(translation(10, 10, 5));
    const Plate plate = plate_with(ball, translation(10, 10, 5));
    const Plan plan = plan_adaptive(joined(std::vector<Mesh>{joined(plate), hollow}), adaptive);
    std::vector<double> expected;
    for (const PlannedLayer& layer : plan.layers)
        expected.push_back(layer.top);
    EXPECT_EQ(with, expected);
}

TEST(MaterialSurface, IgnoresNegativeVolumesOutsideOfTheirPart) {
    const std::vector<double> without = tops_without_negatives();
    EXPECT_LT(without.size(), 35U);
    const TriangleSoup ball = make_sphere(3, 3);
    // Beside, above, below, and in another object.
    for (const Transform& where : {translation(-3.5, 10, 5), translation(10, 10, 13.5),
                                   translation(10, 10, -3.5), translation(42.5, 2.5, 20)})
        EXPECT_EQ(tops(plate_with(ball, where)), without);
}

TEST(MaterialSurface, TakesOfATallNegativeVolumeWhatIsInsideOfItsPart) {
    // A ball of 24 mm through a block of 10 mm: its slopes above are not those of the box beside.
    const Plate plate = plate_with(make_sphere(12, 5), translation(10, 10, 5));
    const std::vector<double> with = tops(plate);
    EXPECT_GT(layers_within(with, 0, 10), layers_within(tops_without_negatives(), 0, 10));
    EXPECT_LT(layers_within(with, 11, 30), 22U);
    const Box3 box = bounding_box(material_surface(plate));
    EXPECT_EQ(box.min, plate.box.min);
    EXPECT_EQ(box.max, plate.box.max);
}

TEST(MaterialSurface, IsThatOfThePartsWithoutNegativeVolumes) {
    Plate plate = plate_with(make_sphere(3, 3), translation(10, 10, 5));
    EXPECT_GT(material_surface(plate).size(), joined(plate).size());
    plate.negatives.clear();
    EXPECT_EQ(material_surface(plate).size(), joined(plate).size());
}

} // namespace
} // namespace lamella::material_surface_cases
