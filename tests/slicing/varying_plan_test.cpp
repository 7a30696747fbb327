#include "lamella/core/error.hpp"
#include "lamella/slicing/varying_plan.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/named_solids.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lamella {
namespace {

void expect_a_stack(const Plan& plan, double z_min) {
    ASSERT_FALSE(plan.layers.empty());
    EXPECT_EQ(plan.layers.front().bottom, z_min);
    for (std::size_t i = 0; i < plan.layers.size(); ++i) {
        const PlannedLayer& layer = plan.layers[i];
        EXPECT_EQ(layer.index, i);
        EXPECT_LT(layer.bottom, layer.top);
        EXPECT_LE(layer.bottom, layer.z);
        EXPECT_LE(layer.z, layer.top);
        if (i > 0) {
            EXPECT_EQ(layer.bottom, plan.layers[i - 1].top);
            EXPECT_LT(plan.layers[i - 1].z, layer.z);
        }
    }
}

TEST(PlanByRanges, WithoutRangesIsUniform) {
    for (const SliceAt at : {SliceAt::bottom, SliceAt::middle, SliceAt::top})
        for (const double height : {0.1, 0.3, 1.0}) {
            const Plan uniform = plan_uniform(2, 5, {.layer_height = height}, at);
            const Plan ranged = plan_by_ranges(2, 5, {.layer_height = height}, at);
            ASSERT_EQ(ranged.layers.size(), uniform.layers.size()) << height;
            EXPECT_EQ(ranged.rule, uniform.rule);
            for (std::size_t i = 0; i < uniform.layers.size(); ++i)
                EXPECT_NEAR(ranged.layers[i].z, uniform.layers[i].z, 1e-12);
        }
}

TEST(PlanByRanges, EveryLayerHasTheHeightOfTheRangeThatItsBottomLiesIn) {
    const Plan plan = plan_by_ranges(10, 40, {.ranges = {{0, 5, 0.1}, {5, 20, 0.2}}, .layer_height = 0.5});
    expect_a_stack(plan, 10);
    ASSERT_EQ(plan.layers.size(), 50 + 75 + 20U);
    for (const PlannedLayer& layer : plan.layers) {
        const double above = layer.bottom - 10;
        const double expected = above < 4.999 ? 0.1 : above < 19.999 ? 0.2 : 0.5;
        EXPECT_NEAR(layer.top - layer.bottom, expected, 1e-9);
        EXPECT_NEAR(layer.z, (layer.bottom + layer.top) / 2, 1e-12);
    }
    EXPECT_NEAR(plan.layers[50].bottom, 15, 1e-12);
    EXPECT_NEAR(plan.layers.back().top, 40, 1e-9);
    // No layer is cut short where a range ends, and between ranges the layer height holds.
    const Plan odd = plan_by_ranges(0, 3, {.ranges = {{0, 1, 0.3}, {2, 3, 0.1}}, .layer_height = 0.5});
    expect_a_stack(odd, 0);
    EXPECT_NEAR(odd.layers[3].top, 1.2, 1e-12);
    EXPECT_NEAR(odd.layers[4].top, 1.7, 1e-12);
    EXPECT_NEAR(odd.layers[5].top, 2.2, 1e-12);
    EXPECT_NEAR(odd.layers[6].top, 2.3, 1e-12);
}

TEST(PlanByRanges, RefusesRangesThatMakeNoSense) {
    using Ranges = std::vector<HeightRange>;
    for (const Ranges& ranges : {Ranges{{5, 5, 0.1}},
                                 {{5, 2, 0.1}},
                                 {{-1, 2, 0.1}},
                                 {{0, 5, 0.1}, {4, 6, 0.1}},
                                 {{5, 6, 0.1}, {0, 5, 0.1}},
                                 {{0, 5, 0}},
                                 {{0, 5, -1}},
                                 {{0, std::nan(""), 0.1}}})
        EXPECT_THROW((void)plan_by_ranges(0, 10, {.ranges = ranges, .layer_height = 0.2}), Error);
    EXPECT_THROW((void)plan_by_ranges(0, 10, {.layer_height = 0}), Error);
    EXPECT_THROW((void)plan_by_ranges(0, 0, {.layer_height = 0.1}), Error);
    EXPECT_THROW((void)plan_by_ranges(0, 1e9, {.ranges = {{0, 1, 1e-3}}, .layer_height = 0.1}), Error);
    EXPECT_THROW((void)plan_by_ranges(0, 1, {.layer_height = 5}, SliceAt::top), Error);
}

TEST(PlanByRanges, AFineRangeCountsOnlyAsFarAsItReachesIntoThePart) {
    EXPECT_EQ(plan_by_ranges(0, 1000, {.ranges = {{0, 0.001, 1e-7}}, .layer_height = 0.1}).layers.size(),
              20'000U);
    EXPECT_EQ(plan_by_ranges(0, 10, {.ranges = {{500, 600, 1e-9}}, .layer_height = 0.1}).layers.size(), 100U);
    test::expect_error(ErrorKind::usage, {"1e-09 mm", "5e+09 layers", "10 mm high"}, [] {
        (void)plan_by_ranges(0, 10, {.ranges = {{5, 600, 1e-9}}, .layer_height = 0.1});
    });
}

TEST(PlanByRanges, OnlyTheLastCutIsMovedToTheTopFace) {
    // After a layer of 1 mm just half a thousandth is left, where layers are finer.
    const Plan plan =
        plan_by_ranges(0, 1.0005, {.ranges = {{1, 2, 0.0003}}, .layer_height = 1}, SliceAt::top);
    ASSERT_EQ(plan.layers.size(), 2U);
    EXPECT_EQ(plan.layers[0].z, 1);
    EXPECT_EQ(plan.layers[1].z, 1.0003);
    const Plan uniform = plan_by_ranges(0, 1.0005, {.layer_height = 1}, SliceAt::top);
    ASSERT_EQ(uniform.layers.size(), 1U);
    EXPECT_EQ(uniform.layers[0].z, 1.0005);
    EXPECT_EQ(uniform.layers[0].top, 1.0005);
}

TEST(PlanByRanges, OfManyRangesEachIsFound) {
    std::vector<HeightRange> ranges;
    for (int i = 0; i < 1000; ++i)
        ranges.push_back({2.0 * i, 2.0 * i + 1, i % 2 == 0 ? 0.5 : 0.25});
    const Plan plan = plan_by_ranges(7, 2007, {.ranges = ranges, .layer_height = 1});
    EXPECT_EQ(plan.layers.size(), 500 * (2 + 1 + 4 + 1));
    for (const PlannedLayer& layer : plan.layers) {
        const double above = layer.bottom - 7;
        const bool in_range = std::fmod(above, 2) < 1;
        ASSERT_EQ(layer.top - layer.bottom, !in_range ? 1 : std::fmod(above, 4) < 2 ? 0.5 : 0.25);
    }
}

TEST(PlanByRanges, NamesAHeightThatIsTooSmallForTheCoordinates) {
    test::expect_error(
        ErrorKind::usage, {"a layer height of 1e-09 mm is too small", "around 1000000000"}, [] {
            (void)plan_by_ranges(1e9, 1e9 + 1e-6, {.ranges = {{0, 1e-7, 1e-9}}, .layer_height = 1e-8});
        });
}

/// The largest |n.z| of the triangles that reach into a layer.
double steepest(const TriangleSoup& mesh, const PlannedLayer& layer) {
    double worst = 0;
    for (std::size_t i = 0; i < mesh.size(); ++i) {
        const Triangle3 t = mesh.placed(i);
        const auto [low, high] = std::minmax({t[0].z, t[1].z, t[2].z});
        if (high <= layer.bottom || low >= layer.top)
            continue;
        const Point3 u{t[1].x - t[0].x, t[1].y - t[0].y, t[1].z - t[0].z};
        const Point3 v{t[2].x - t[0].x, t[2].y - t[0].y, t[2].z - t[0].z};
        const double x = u.y * v.z - u.z * v.y;
        const double y = u.z * v.x - u.x * v.z;
        const double z = u.x * v.y - u.y * v.x;
        const double length = std::hypot(x, y, z);
        if (length > 0)
            worst = std::max(worst, std::abs(z) / length);
    }
    return worst;
}

class AdaptivePlan : public testing::TestWithParam<test::Solid> {};

INSTANTIATE_TEST_SUITE_P(Small, AdaptivePlan, testing::ValuesIn(test::small_solids()), test::solid_name);

TEST_P(AdaptivePlan, KeepsTheCuspBoundForEveryTriangle) {
    for (const Transform& map : {Transform{}, rotation('x', 33), scaling(1, 1, 0.5)}) {
        const TriangleSoup mesh = GetParam().make().transformed(map);
        const Box3 box = bounding_box(mesh);
        const double height = box.max.z - box.min.z;
        for (const double cusp : {0.001, 0.004, 0.02}) {
            const AdaptiveLayers layers{
                .min_height = height / 200, .max_height = height / 20, .cusp_mm = cusp * height};
            const Plan plan = plan_adaptive(mesh, layers, SliceAt::middle, {.threads = 2});
            expect_a_stack(plan, box.min.z);
            EXPECT_LT(plan.layers.back().z, box.max.z);
            EXPECT_GT(plan.layers.back().top, box.max.z - layers.min_height);
            for (const PlannedLayer& layer : plan.layers) {
                const double h = layer.top - layer.bottom;
                EXPECT_GE(h, layers.min_height * (1 - 1e-9));
                EXPECT_LE(h, layers.max_height * (1 + 1e-9));
                if (h > layers.min_height * (1 + 1e-9)) {
                    EXPECT_LE(h * steepest(mesh, layer), layers.cusp_mm * (1 + 1e-6)) << "z " << layer.z;
                }
            }
        }
    }
}

TEST(AdaptivePlan, MakesLayersHighOnWallsAndLowOnSlopes) {
    // A sphere: steep at the equator, level at the poles.
    const Plan plan =
        plan_adaptive(make_sphere(10, 5), {.min_height = 0.05, .max_height = 1, .cusp_mm = 0.1});
    const auto height_near = [&](double z) {
        for (const PlannedLayer& layer : plan.layers)
            if (layer.bottom <= z && z < layer.top)
                return layer.top - layer.bottom;
        return 0.0;
    };
    EXPECT_GT(height_near(0), 0.5);
    EXPECT_LT(height_near(9.5), 0.12);
    EXPECT_LT(height_near(-9.5), 0.12);
    // Upright walls alone: the largest height, but for the caps.
    const Plan tower =
        plan_adaptive(make_box(1, 1, 10), {.min_height = 0.1, .max_height = 1, .cusp_mm = 0.1});
    EXPECT_LT(tower.layers.size(), 16U);
    EXPECT_NEAR(tower.layers.back().top, 10, 1e-9);
}

TEST(AdaptivePlan, IsTheSameForAnyNumberOfThreadsAndEitherKindOfMesh) {
    const TriangleSoup soup = make_rook();
    const IndexedMesh mesh = weld(soup);
    const AdaptiveLayers layers{.min_height = 0.02, .max_height = 0.3, .cusp_mm = 0.02};
    const Plan one = plan_adaptive(soup, layers, SliceAt::middle, {.threads = 1});
    for (const Plan& other :
         {plan_adaptive(soup, layers, SliceAt::middle, {.threads = 7}), plan_adaptive(mesh, layers)}) {
        ASSERT_EQ(other.layers.size(), one.layers.size());
        for (std::size_t i = 0; i < one.layers.size(); ++i) {
            EXPECT_EQ(other.layers[i].z, one.layers[i].z);
            EXPECT_EQ(other.layers[i].top, one.layers[i].top);
        }
    }
}

TEST(AdaptivePlan, RefusesHeightsThatMakeNoSense) {
    const TriangleSoup box = make_box(1, 1, 1);
    for (const AdaptiveLayers& layers : {AdaptiveLayers{.min_height = 0},
                                         {.min_height = 0.2, .max_height = 0.1},
                                         {.cusp_mm = 0},
                                         {.cusp_mm = std::nan("")},
                                         {.min_height = 1e-12, .max_height = 1}})
        EXPECT_THROW((void)plan_adaptive(box, layers), Error);
    EXPECT_THROW((void)plan_adaptive(TriangleSoup(), {}), Error);
}

TEST(PlanAdaptive, HoldsNoMoreLayersThanAreAllowed) {
    const Mesh box = make_box(1, 1, 10);
    const AdaptiveLayers layers{.min_height = 0.1, .max_height = 0.5, .cusp_mm = 0.1};
    const std::size_t count = plan_adaptive(box, layers).layers.size();
    EXPECT_EQ(plan_adaptive(box, layers, SliceAt::middle, {}, count).layers.size(), count);
    // These would be 10^9 layers.
    for (const AdaptiveLayers& many : {layers, AdaptiveLayers{.min_height = 1e-8, .max_height = 1e-8}})
        try {
            (void)plan_adaptive(box, many, SliceAt::middle, {}, count - 1);
            ADD_FAILURE() << "there are more layers";
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::limit) << error.what();
        }
}

} // namespace
} // namespace lamella
