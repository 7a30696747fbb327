// What each plan holds is shown beside its function; here, that a layering asks the right one.

#include "lamella/core/error.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/layering.hpp"

#include "fixtures/expect_error.hpp"
#include "parts/shapes.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::expect_error;

const Box3 ten_high{{0, 0, 0}, {1, 1, 10}};

Mesh ten_high_mesh() {
    return make_box(1, 1, 10);
}

Mesh nobody_asks() {
    ADD_FAILURE() << "a mesh was made for a plan that does not look at it";
    return {};
}

void expect_same_plan(const Plan& plan, const Plan& expected) {
    EXPECT_EQ(plan.rule, expected.rule);
    ASSERT_EQ(plan.layers.size(), expected.layers.size());
    for (std::size_t i = 0; i < plan.layers.size(); ++i) {
        EXPECT_EQ(plan.layers[i].index, expected.layers[i].index);
        EXPECT_EQ(plan.layers[i].z, expected.layers[i].z);
        EXPECT_EQ(plan.layers[i].bottom, expected.layers[i].bottom);
        EXPECT_EQ(plan.layers[i].top, expected.layers[i].top);
    }
}

std::vector<Cut> every_cut() {
    return {UniformLayers{.layer_height = 0.5}, ListedPlanes{.z = {0.5, 1, 2, 4, 5, 6, 7, 8, 9, 9.5}},
            HeightRanges{.ranges = {{0, 5, 0.25}}, .layer_height = 1},
            AdaptiveLayers{.min_height = 0.2, .max_height = 0.7}};
}

TEST(Layering, CutsEachWayWhereItsPlanDoes) {
    for (const SliceAt at : {SliceAt::bottom, SliceAt::middle, SliceAt::top}) {
        expect_same_plan(
            plan_of({.cut = UniformLayers{.layer_height = 0.3}, .at = at, .only = {}}, ten_high, nobody_asks),
            plan_uniform(0, 10, {.layer_height = 0.3}, at));
        expect_same_plan(plan_of({.cut = ListedPlanes{.z = {4}, .single_height = 2}, .at = at, .only = {}},
                                 ten_high, nobody_asks),
                         plan_listed({4}, at, 2));
        expect_same_plan(
            plan_of({.cut = HeightRanges{.ranges = {{0, 5, 0.25}}, .layer_height = 1}, .at = at, .only = {}},
                    ten_high, nobody_asks),
            plan_by_ranges(0, 10, {.ranges = {{0, 5, 0.25}}, .layer_height = 1}, at));
        const AdaptiveLayers adaptive{.min_height = 0.2, .max_height = 0.7};
        expect_same_plan(plan_of({.cut = adaptive, .at = at, .only = {}}, ten_high, ten_high_mesh),
                         plan_adaptive(ten_high_mesh(), adaptive, at));
    }
}

TEST(Layering, KeepsOfEveryWayToCutOnlyTheLayersAskedFor) {
    for (const Cut& cut : every_cut()) {
        const Plan whole = plan_of({.cut = cut, .at = SliceAt::middle, .only = {}}, ten_high, ten_high_mesh);
        const PlaneSelection only{.z_range = std::pair{1.0, 8.0}, .index_range = std::pair{2U, 9U}};
        Plan expected{.layers = {}, .rule = whole.rule};
        for (const PlannedLayer& layer : whole.layers)
            if (1 <= layer.z && layer.z <= 8 && 2 <= layer.index && layer.index < 9)
                expected.layers.push_back(layer);
        EXPECT_LT(expected.layers.size(), whole.layers.size());
        expect_same_plan(plan_of({.cut = cut, .at = SliceAt::middle, .only = only}, ten_high, ten_high_mesh),
                         expected);
    }
}

TEST(Layering, RefusesPlanesThatAllMissThePart) {
    expect_error(ErrorKind::usage, {"none of the planes meets the part", "from z = 0 to 10 mm"}, [] {
        (void)plan_of({.cut = ListedPlanes{.z = {-1, 11}}, .at = SliceAt::middle, .only = {}}, ten_high,
                      nobody_asks);
    });
    for (const Cut& cut : every_cut())
        expect_error(ErrorKind::usage, {"from"}, [&] {
            (void)plan_of({.cut = cut, .at = SliceAt::middle, .only = {.z_range = std::pair{20.0, 30.0}}},
                          ten_high, ten_high_mesh);
        });
}

TEST(Layering, TakesAFaceForMetByTheRuleOfThePlane) {
    const auto cut_at = [](double z, SliceAt at) {
        return plan_of({.cut = ListedPlanes{.z = {z}}, .at = at, .only = {}}, ten_high, nobody_asks)
            .layers.size();
    };
    EXPECT_EQ(cut_at(0, SliceAt::bottom), 1U);
    EXPECT_EQ(cut_at(10, SliceAt::top), 1U);
    EXPECT_THROW((void)cut_at(10, SliceAt::bottom), Error);
    EXPECT_THROW((void)cut_at(0, SliceAt::top), Error);
}

TEST(Layering, HasNoPlanesOfAListWithoutNumbers) {
    expect_error(ErrorKind::usage, {"the list of z holds no number"}, [] {
        (void)plan_of({.cut = ListedPlanes{}, .at = SliceAt::middle, .only = {}}, ten_high, nobody_asks);
    });
}

} // namespace
} // namespace lamella
