#include "lamella/contour/measure.hpp"
#include "lamella/slicing/slice.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/solids.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace lamella {
namespace {

constexpr std::array both_rules{SliceAt::bottom, SliceAt::top};

TEST(SectionAreas, OfABoxAreItsBaseUpToTheFaceThatTheRuleLeavesOut) {
    const TriangleSoup box = make_box(3, 4, 5);
    const std::vector<double> z{-1, 0, 1, 4.999, 5, 6};
    EXPECT_EQ(section_areas(box, plan_listed(z, SliceAt::bottom)),
              (std::vector<double>{0, 12, 12, 12, 0, 0}));
    EXPECT_EQ(section_areas(box, plan_listed(z, SliceAt::top)), (std::vector<double>{0, 0, 12, 12, 12, 0}));
}

TEST(SectionAreas, OfAnOctahedronFollowItsSlope) {
    std::vector<double> z;
    for (int i = -10; i <= 10; ++i)
        z.push_back(i / 8.0);
    for (const SliceAt at : both_rules) {
        const std::vector<double> areas = section_areas(test::soup(test::octahedron(1)), plan_listed(z, at));
        for (std::size_t i = 0; i < z.size(); ++i) {
            const double half = std::max(0.0, 1 - std::abs(z[i]));
            EXPECT_NEAR(areas[i], 2 * half * half, 1e-15) << z[i];
        }
    }
}

TEST(SectionAreas, OfATorusLeaveOutItsHole) {
    constexpr unsigned segments = 200;
    const TriangleSoup torus = make_torus(10, 3, segments, 100);
    const std::vector<double> z{-2, -1, 0, 1.5};
    const std::vector<double> areas = section_areas(torus, plan_listed(z));
    for (std::size_t i = 0; i < z.size(); ++i) {
        const double half = std::sqrt(9 - z[i] * z[i]);
        const double round = std::numbers::pi * ((10 + half) * (10 + half) - (10 - half) * (10 - half));
        EXPECT_NEAR(areas[i], round, round * 2e-3);
    }
}

TEST(SectionAreas, AreNegativeForABodyInsideOut) {
    const TriangleSoup box = test::soup(test::flipped(test::box_triangles({0, 0, 0}, {3, 4, 5})));
    EXPECT_EQ(section_areas(box, plan_listed({2})), std::vector<double>{-12});
}

TEST(SectionAreas, LoseNoDigitsFarFromTheOrigin) {
    const TriangleSoup box = make_box(1, 1, 1).transformed(translation(1e9, -1e9, 0));
    EXPECT_NEAR(section_areas(box, plan_listed({0.5})).front(), 1.0, 1e-6);
}

TEST(SectionAreas, EqualTheAreasOfTheLayers) {
    for (const TriangleSoup& soup :
         {make_sphere(10, 3), make_torus(10, 3, 24, 16).transformed(rotation('x', 90)),
          test::soup(test::rugged_drum(300, 9)), make_lattice({2, 2, 2, 4.5, 1.2, 2}),
          make_cylinder(4, 7, 50).transformed(rotation('y', 33))}) {
        const Box3 box = bounding_box(soup);
        for (const SliceAt at : {SliceAt::bottom, SliceAt::middle, SliceAt::top}) {
            UniformLayers layers;
            layers.layer_height = (box.max.z - box.min.z) / 40;
            const Plan plan = plan_uniform(box.min.z, box.max.z, layers, at);
            const LayerStack stack = slice(soup, plan);
            const std::vector<double> areas = section_areas(soup, plan);
            const IndexedMesh mesh = test::indexed(test::triangles_of(soup));
            ASSERT_EQ(areas.size(), stack.size());
            for (std::size_t i = 0; i < areas.size(); ++i)
                EXPECT_NEAR(areas[i], measure(stack[i]).area_mm2, 1e-9);
        }
    }
}

TEST(SectionAreas, SumUpToTheVolume) {
    const TriangleSoup sphere = make_sphere(10, 4);
    UniformLayers layers;
    layers.layer_height = 0.02;
    double sum = 0;
    for (const double area : section_areas(sphere, plan_uniform(-10, 10, layers)))
        sum += area * layers.layer_height;
    EXPECT_NEAR(sum, volume(sphere), 1e-4 * sum);
}

TEST(SectionAreas, AreTheSameBitsForAnyNumberOfThreadsAndEitherKindOfMesh) {
    const TriangleSoup soup = make_sphere(10, 4);
    const IndexedMesh mesh = test::indexed(test::triangles_of(soup));
    UniformLayers layers;
    layers.layer_height = 0.07;
    const Plan plan = plan_uniform(-10, 10, layers);
    const std::vector<double> areas = section_areas(soup, plan, {.threads = 1});
    for (const unsigned threads : {1U, 2U, 7U}) {
        EXPECT_EQ(section_areas(soup, plan, {.threads = threads}), areas);
        EXPECT_EQ(section_areas(mesh, plan, {.threads = threads}), areas);
    }
}

TEST(SectionAreas, OfNothingAreZero) {
    EXPECT_EQ(section_areas(TriangleSoup(), plan_listed({0, 1})), (std::vector<double>{0, 0}));
    EXPECT_EQ(section_areas(IndexedMesh(), plan_listed({0, 1})), (std::vector<double>{0, 0}));
    EXPECT_TRUE(section_areas(make_box(1, 1, 1), Plan()).empty());
}

TEST(SectionAreas, EndWhenTheCallerCancels) {
    CancelFlag stop;
    stop.request();
    test::expect_error(ErrorKind::cancelled, {},
                       [&] { (void)section_areas(make_sphere(1, 3), plan_listed({0}), {.cancel = &stop}); });
}

} // namespace
} // namespace lamella
