#include "lamella/slicing/plan.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace lamella {
namespace {

using test::expect_error;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr std::array everywhere{SliceAt::bottom, SliceAt::middle, SliceAt::top};

/// Eight layers from 0 to 4 mm, or some of them.
Plan half_millimetres(const PlaneSelection& only) {
    return plan_uniform(0, 4, {.layer_height = 0.5}, SliceAt::bottom, only);
}

std::size_t count(double z_max, double height, SliceAt at) {
    return plan_uniform(0, z_max, {.layer_height = height}, at).layers.size();
}

std::vector<double> cuts(const Plan& plan) {
    std::vector<double> z;
    for (const PlannedLayer& layer : plan.layers)
        z.push_back(layer.z);
    return z;
}

std::vector<std::uint64_t> indices(const Plan& plan) {
    std::vector<std::uint64_t> out;
    for (const PlannedLayer& layer : plan.layers)
        out.push_back(layer.index);
    return out;
}

/// What every plan keeps to.
void expect_sound(const Plan& plan) {
    for (std::size_t i = 0; i < plan.layers.size(); ++i) {
        const PlannedLayer& layer = plan.layers[i];
        EXPECT_LE(layer.bottom, layer.z) << i;
        EXPECT_LE(layer.z, layer.top) << i;
        if (i > 0) {
            EXPECT_LT(plan.layers[i - 1].z, layer.z) << i;
            EXPECT_LT(plan.layers[i - 1].index, layer.index) << i;
        }
    }
}

TEST(PlanUniform, MakesThirtyLayersOfThreeMillimetresAtATenthWhereverTheyAreCut) {
    for (const SliceAt at : everywhere) {
        const Plan plan = plan_uniform(0, 3, {.layer_height = 0.1}, at);
        ASSERT_EQ(plan.layers.size(), 30U);
        expect_sound(plan);
        const double f = at == SliceAt::bottom ? 0 : at == SliceAt::middle ? 0.5 : 1;
        for (std::size_t i = 0; i < 30; ++i) {
            const PlannedLayer& layer = plan.layers[i];
            EXPECT_EQ(layer.index, i);
            EXPECT_NEAR(layer.bottom, 0.1 * static_cast<double>(i), 1e-15);
            EXPECT_NEAR(layer.z, 0.1 * (static_cast<double>(i) + f), 1e-15);
            EXPECT_NEAR(layer.top, 0.1 * (static_cast<double>(i) + 1), 1e-15);
        }
    }
}

TEST(PlanUniform, CutsTheBottomFaceFromAboveAndTheTopFaceFromBelow) {
    EXPECT_EQ(plan_uniform(1, 4, {.layer_height = 0.1}, SliceAt::bottom).layers.front().z, 1.0);
    EXPECT_EQ(plan_uniform(1, 4, {.layer_height = 0.1}, SliceAt::top).layers.back().z, 4.0);
    EXPECT_EQ(plan_uniform(0, 3, {.layer_height = 0.1}, SliceAt::bottom).rule, PlaneRule::section_above);
    EXPECT_EQ(plan_uniform(0, 3, {.layer_height = 0.1}, SliceAt::middle).rule, PlaneRule::section_above);
    EXPECT_EQ(plan_uniform(0, 3, {.layer_height = 0.1}, SliceAt::top).rule, PlaneRule::section_below);
}

TEST(PlanUniform, KeepsALastLayerThatIsNotFullWhenItsCutMeetsThePart) {
    EXPECT_EQ(count(3.04, 0.1, SliceAt::bottom), 31U);
    EXPECT_EQ(count(3.04, 0.1, SliceAt::middle), 30U);
    EXPECT_EQ(count(3.06, 0.1, SliceAt::middle), 31U);
    EXPECT_EQ(count(3.04, 0.1, SliceAt::top), 30U);
    EXPECT_EQ(count(3.09, 0.1, SliceAt::top), 30U);
}

TEST(PlanUniform, DropsALayerCutInTheMiddleThatIsExactlyHalfFull) {
    EXPECT_EQ(count(3.25, 0.5, SliceAt::middle), 6U);
    EXPECT_EQ(count(3.75, 0.5, SliceAt::middle), 7U);
}

TEST(PlanUniform, CountsARemainderBelowAThousandthOfALayerAsNothing) {
    EXPECT_EQ(count(3.00005, 0.1, SliceAt::bottom), 30U);
    EXPECT_EQ(count(3.0002, 0.1, SliceAt::bottom), 31U);
    EXPECT_EQ(count(2.9998, 0.1, SliceAt::top), 29U);
    const Plan plan = plan_uniform(0, 2.99995, {.layer_height = 0.1}, SliceAt::top);
    EXPECT_EQ(plan.layers.size(), 30U);
    EXPECT_EQ(plan.layers.back().z, 2.99995) << "the last cut must still meet the top face";
}

TEST(PlanUniform, IsNotMisledByTheNoiseOfSinglePrecision) {
    // The nearest floats of 0.7, 1.3 ...: none of them is the number it stands for.
    for (const float z_min : {-12.3F, -0.1F, 0.7F, 1.3F, 101.9F}) {
        const float z_max = static_cast<float>(static_cast<double>(z_min) + 3.0);
        for (const SliceAt at : everywhere)
            EXPECT_EQ(plan_uniform(z_min, z_max, {.layer_height = 0.1}, at).layers.size(), 30U) << z_min;
    }
}

TEST(PlanUniform, KeepsItsPromisesForRandomHeights) {
    test::Random random(1);
    for (int trial = 0; trial < 2000; ++trial) {
        const double z_min = random.real(-100, 100);
        const double height = std::exp(random.real(-5, 2));
        const double z_max = z_min + height * random.real(1.01, 60);
        for (const SliceAt at : everywhere) {
            const Plan plan = plan_uniform(z_min, z_max, {.layer_height = height}, at);
            expect_sound(plan);
            const std::vector<double> z = cuts(plan);
            const double f = at == SliceAt::bottom ? 0 : at == SliceAt::middle ? 0.5 : 1;
            for (std::size_t i = 0; i < z.size(); ++i) {
                const double exact = z_min + (static_cast<double>(i) + f) * height;
                EXPECT_NEAR(z[i], exact, 1e-3 * height) << "only a lowered last cut may be off at all";
                if (i + 1 < z.size()) {
                    EXPECT_NEAR(z[i], exact, 1e-12);
                    EXPECT_EQ(plan.layers[i].top, plan.layers[i + 1].bottom) << "slabs leave no gap";
                }
            }
            if (at == SliceAt::top) {
                EXPECT_GT(z.front(), z_min);
                EXPECT_LE(z.back(), z_max);
                EXPECT_GT(z.back() + height, z_max + 0.999e-3 * height) << "no further layer fits";
            } else {
                EXPECT_GE(z.front(), z_min);
                EXPECT_LT(z.back(), z_max);
                EXPECT_GE(z.back() + height, z_max - 1.001e-3 * height) << "no further cut meets the part";
            }
        }
    }
}

TEST(PlanUniform, NeverAddsUpRoundingErrors) {
    const Plan plan = plan_uniform(0, 10000, {.layer_height = 0.1}, SliceAt::bottom);
    ASSERT_EQ(plan.layers.size(), 100000U);
    EXPECT_NEAR(plan.layers[99999].z, 9999.9, 4e-12);
}

TEST(PlanUniform, GivesTheFirstLayerAHeightOfItsOwn) {
    for (const SliceAt at : everywhere) {
        const Plan plan = plan_uniform(2, 4, {.layer_height = 0.25, .first_layer_height = 0.5}, at);
        ASSERT_EQ(plan.layers.size(), 7U);
        const double f = at == SliceAt::bottom ? 0 : at == SliceAt::middle ? 0.5 : 1;
        EXPECT_EQ(plan.layers[0].bottom, 2.0);
        EXPECT_EQ(plan.layers[0].z, 2 + f * 0.5);
        EXPECT_EQ(plan.layers[0].top, 2.5);
        EXPECT_EQ(plan.layers[1].bottom, 2.5);
        EXPECT_EQ(plan.layers[1].z, 2.5 + f * 0.25);
        EXPECT_EQ(plan.layers[6].top, 4.0);
    }
}

TEST(PlanUniform, MakesOneLayerWhenTheFirstOneHoldsTheWholePart) {
    const UniformLayers wanted{.layer_height = 0.1, .first_layer_height = 5};
    EXPECT_EQ(cuts(plan_uniform(0, 3, wanted)), std::vector<double>{2.5});
    EXPECT_EQ(cuts(plan_uniform(0, 3, wanted, SliceAt::bottom)), std::vector<double>{0.0});
}

TEST(PlanUniform, KeepsTheCutsInAClosedRangeWithTheirIndices) {
    PlaneSelection only;
    only.z_range = {1.0, 2.0};
    const Plan plan = half_millimetres(only);
    EXPECT_EQ(cuts(plan), (std::vector<double>{1, 1.5, 2}));
    EXPECT_EQ(indices(plan), (std::vector<std::uint64_t>{2, 3, 4}));
}

TEST(PlanUniform, KeepsAHalfOpenRangeOfIndices) {
    PlaneSelection only;
    only.index_range = {3, 5};
    EXPECT_EQ(indices(half_millimetres(only)), (std::vector<std::uint64_t>{3, 4}));
    only.index_range = {6, std::numeric_limits<std::uint64_t>::max()};
    EXPECT_EQ(indices(half_millimetres(only)), (std::vector<std::uint64_t>{6, 7}));
    only.z_range = {0.0, 3.0};
    EXPECT_EQ(indices(half_millimetres(only)), (std::vector<std::uint64_t>{6})) << "both ranges hold";
}

TEST(PlanUniform, IsThePartOfTheWholePlanThatARangeNames) {
    for (const SliceAt at : everywhere) {
        const Plan whole = plan_uniform(-1.7, 11.3, {.layer_height = 0.07}, at);
        const Plan part = plan_uniform(-1.7, 11.3, {.layer_height = 0.07}, at, {.index_range = {{100, 150}}});
        ASSERT_EQ(part.layers.size(), 50U);
        for (std::size_t i = 0; i < 50; ++i) {
            EXPECT_EQ(part.layers[i].z, whole.layers[100 + i].z);
            EXPECT_EQ(part.layers[i].bottom, whole.layers[100 + i].bottom);
            EXPECT_EQ(part.layers[i].top, whole.layers[100 + i].top);
        }
    }
}

TEST(PlanUniform, RefusesHeightsThatAreNotPositiveNumbers) {
    for (const double bad : {0.0, -0.0, -0.1, nan, infinity, -infinity}) {
        expect_error(ErrorKind::usage, {"the layer height is", "above 0"},
                     [&] { (void)plan_uniform(0, 3, {.layer_height = bad}, SliceAt::middle); });
        UniformLayers wanted;
        wanted.first_layer_height = bad;
        expect_error(ErrorKind::usage, {"the first layer height is", "above 0"},
                     [&] { (void)plan_uniform(0, 3, wanted); });
    }
    expect_error(ErrorKind::usage, {"-0.25 mm"},
                 [] { (void)plan_uniform(0, 3, {.layer_height = -0.25}, SliceAt::middle); });
}

TEST(PlanUniform, RefusesAPartWithoutHeight) {
    expect_error(ErrorKind::usage, {"no height", "from 2.5 to 2.5", "slicing direction"},
                 [] { (void)plan_uniform(2.5, 2.5, {}); });
    expect_error(ErrorKind::usage, {"from 3 to 2"}, [] { (void)plan_uniform(3, 2, {}); });
    expect_error(ErrorKind::usage, {"inf to -inf"}, [] { (void)plan_uniform(infinity, -infinity, {}); });
    expect_error(ErrorKind::usage, {"nan"}, [] { (void)plan_uniform(nan, 1, {}); });
    expect_error(ErrorKind::usage, {"nan"}, [] { (void)plan_uniform(0, nan, {}); });
}

TEST(PlanUniform, RefusesAPartThatReachesToInfinity) {
    expect_error(ErrorKind::usage, {"from z = 0 to inf", "finite"},
                 [] { (void)plan_uniform(0, infinity, {}); });
    expect_error(ErrorKind::usage, {"-inf", "finite"}, [] { (void)plan_uniform(-infinity, 0, {}); });
}

TEST(PlanUniform, RefusesALayerHeightThatMissesThePart) {
    expect_error(ErrorKind::usage, {"z = 4 mm", "from 0 to 3 mm", "below 3 mm"},
                 [] { (void)plan_uniform(0, 3, {.layer_height = 4}, SliceAt::top); });
    expect_error(ErrorKind::usage, {"z = 3.5 mm", "from 0 to 3 mm"},
                 [] { (void)plan_uniform(0, 3, {.layer_height = 7}, SliceAt::middle); });
    EXPECT_EQ(count(3, 1000, SliceAt::bottom), 1U) << "cut at the bottom, a single layer is there";
    expect_error(ErrorKind::usage, {"3 mm high", "a thousandth", "1e+300 mm", "below 3000 mm"},
                 [] { (void)plan_uniform(0, 3, {.layer_height = 1e300}, SliceAt::bottom); });
    EXPECT_EQ(count(3, 2999, SliceAt::bottom), 1U) << "what the message says is possible";
    expect_error(ErrorKind::usage, {"3 mm high", "a thousandth", "3000 mm"},
                 [] { (void)plan_uniform(0, 3, {.layer_height = 3000}, SliceAt::bottom); });
    const UniformLayers thick_first{.layer_height = 0.1, .first_layer_height = 7};
    expect_error(ErrorKind::usage, {"z = 3.5 mm", "choose a first layer height below 3 mm"},
                 [&] { (void)plan_uniform(0, 3, thick_first); });
    expect_error(ErrorKind::usage, {"1e+300"},
                 [] { (void)plan_uniform(0, 3, {.layer_height = 1e300}, SliceAt::top); });
}

TEST(PlanUniform, RefusesRangesThatHoldNoLayer) {
    constexpr std::uint64_t open = std::numeric_limits<std::uint64_t>::max();
    PlaneSelection only;
    only.index_range = {8, 12};
    expect_error(ErrorKind::usage, {"layers 0 to 7; 8:12 is beyond them"},
                 [&] { (void)half_millimetres(only); });
    only.index_range = {9, open};
    expect_error(ErrorKind::usage, {"layers 0 to 7; 9: is beyond them"},
                 [&] { (void)half_millimetres(only); });
    only.index_range.reset();
    for (const auto& range : {std::pair(4.5, 9.0), std::pair(0.6, 0.9), std::pair(-3.0, -1.0)}) {
        only.z_range = range;
        expect_error(ErrorKind::usage, {"from 0 to 4 mm", "z range", "from 0 to 3.5 mm"},
                     [&] { (void)half_millimetres(only); });
    }
    only.index_range = {2, 4};
    only.z_range = {0.0, 0.5};
    expect_error(ErrorKind::usage, {"layers 2:4", "0 to 0.5 mm", "from 1 to 1.5 mm"},
                 [&] { (void)half_millimetres(only); });
}

TEST(PlanUniform, NamesTheEndThatAnOpenRangeHas) {
    PlaneSelection only;
    for (const double far : {std::numeric_limits<double>::max(), infinity}) {
        only.z_range = {-far, -1.0};
        expect_error(ErrorKind::usage, {"z range up to -1 mm"}, [&] { (void)half_millimetres(only); });
        only.z_range = {9.0, far};
        expect_error(ErrorKind::usage, {"z range from 9 mm on"}, [&] { (void)half_millimetres(only); });
    }
}

TEST(PlanUniform, CallsAnEmptyRangeEmpty) {
    PlaneSelection only;
    for (const auto& [range, text] : {std::pair(std::pair(5U, 5U), "the layer range 5:5 is empty"),
                                      std::pair(std::pair(5U, 2U), "the layer range 5:2 is empty")}) {
        only.index_range = range;
        expect_error(ErrorKind::usage, {text}, [&] { (void)half_millimetres(only); });
    }
    only.index_range.reset();
    only.z_range = {2.0, 1.0};
    expect_error(ErrorKind::usage, {"z range 2 to 1 mm is empty"}, [&] { (void)half_millimetres(only); });
    only.z_range = {nan, nan};
    expect_error(ErrorKind::usage, {"nan", "is empty"}, [&] { (void)half_millimetres(only); });
}

TEST(PlanUniform, PutsALastCutThatRoundingLeavesBesideTheTopFaceOnIt) {
    test::Random random(2);
    int beside = 0;
    for (int trial = 0; trial < 5000; ++trial) {
        const double z_min = random.real(-50, 50);
        const double height = random.real(0.01, 0.5);
        const auto n = static_cast<double>(random.integer(1, 2000));
        // The top face as another program might have computed it.
        const double z_max = z_min + n * height + random.real(-1, 1) * 1e-15;
        const Plan plan = plan_uniform(z_min, z_max, {.layer_height = height}, SliceAt::top);
        ASSERT_EQ(plan.layers.size(), static_cast<std::size_t>(n));
        ASSERT_EQ(plan.layers.back().z, z_max) << "from " << z_min << " by " << height;
        expect_sound(plan);
        beside += z_min + height + (n - 1) * height < z_max ? 1 : 0;
    }
    EXPECT_GT(beside, 100) << "the case that this test is about";
}

TEST(PlanUniform, LeavesALastCutBelowTheTopFaceWhereItReallyIs) {
    EXPECT_EQ(plan_uniform(0, 3.0001, {.layer_height = 0.5}, SliceAt::top).layers.back().z, 3.0);
    EXPECT_EQ(plan_uniform(0, 3 + 1e-12, {.layer_height = 0.5}, SliceAt::top).layers.back().z, 3.0);
}

TEST(PlanUniform, RefusesMoreLayersThanCanBeNumbered) {
    expect_error(ErrorKind::usage, {"1e-10 mm", "3 mm high", "2147483646"},
                 [] { (void)plan_uniform(0, 3, {.layer_height = 1e-10}, SliceAt::middle); });
    for (const double height : {1e-300, 5e-324})
        for (const SliceAt at : everywhere)
            expect_error(ErrorKind::usage, {"2147483646"},
                         [&] { (void)plan_uniform(0, 3, {.layer_height = height}, at); });
    expect_error(ErrorKind::usage, {"2147483646"}, [] { (void)plan_uniform(-1e300, 1e300, {}); });
    expect_error(ErrorKind::usage, {"2147483646"}, [] { (void)plan_uniform(-1.7e308, 1.7e308, {}); });
}

TEST(PlanUniform, WorksInAnyUnit) {
    for (const double unit : {1e-300, 1e-30, 1e-6, 1e6, 1e30, 1e300})
        for (const SliceAt at : everywhere)
            EXPECT_EQ(plan_uniform(0, 3 * unit, {.layer_height = 0.1 * unit}, at).layers.size(), 30U) << unit;
}

TEST(PlanUniform, RefusesCutsThatFallOnTheSameNumber) {
    expect_error(ErrorKind::usage, {"0.1 mm is too small", "1e+17"},
                 [] { (void)plan_uniform(1e17, 1e17 + 64, {.layer_height = 0.1}, SliceAt::bottom); });
}

TEST(PlanListed, CutsExactlyWhereTheListSays) {
    const std::vector<double> z{-1.5, 0.1, 0.30000000000000004, 7};
    for (const SliceAt at : everywhere) {
        const Plan plan = plan_listed(z, at);
        EXPECT_EQ(cuts(plan), z);
        EXPECT_EQ(indices(plan), (std::vector<std::uint64_t>{0, 1, 2, 3}));
        EXPECT_EQ(plan.rule, at == SliceAt::top ? PlaneRule::section_below : PlaneRule::section_above);
        expect_sound(plan);
    }
}

TEST(PlanListed, ReachesHalfWayToItsNeighboursWhenCutInTheMiddle) {
    const Plan plan = plan_listed({0, 1, 3}, SliceAt::middle);
    EXPECT_EQ(plan.layers[0].bottom, -0.5) << "the outermost slab goes on as far as on its other side";
    EXPECT_EQ(plan.layers[0].top, 0.5);
    EXPECT_EQ(plan.layers[1].bottom, 0.5);
    EXPECT_EQ(plan.layers[1].top, 2.0);
    EXPECT_EQ(plan.layers[2].bottom, 2.0);
    EXPECT_EQ(plan.layers[2].top, 4.0);
}

TEST(PlanListed, ReachesToTheNextCutWhenCutAtTheBottomAndToTheOneBeforeWhenCutAtTheTop) {
    const Plan bottom = plan_listed({0, 1, 3}, SliceAt::bottom);
    EXPECT_EQ(bottom.layers[0].bottom, 0.0);
    EXPECT_EQ(bottom.layers[0].top, 1.0);
    EXPECT_EQ(bottom.layers[1].top, 3.0);
    EXPECT_EQ(bottom.layers[2].bottom, 3.0);
    EXPECT_EQ(bottom.layers[2].top, 5.0);
    const Plan top = plan_listed({0, 1, 3}, SliceAt::top);
    EXPECT_EQ(top.layers[0].bottom, -1.0);
    EXPECT_EQ(top.layers[0].top, 0.0);
    EXPECT_EQ(top.layers[1].bottom, 0.0);
    EXPECT_EQ(top.layers[2].bottom, 1.0);
    EXPECT_EQ(top.layers[2].top, 3.0);
}

TEST(PlanListed, MakesOfASingleCutALayerOfTheHeightGiven) {
    for (const SliceAt at : everywhere) {
        const Plan plan = plan_listed({4.25}, at, 0.5);
        ASSERT_EQ(plan.layers.size(), 1U);
        EXPECT_EQ(plan.layers[0].z, 4.25);
        EXPECT_EQ(plan.layers[0].bottom, at == SliceAt::bottom ? 4.25 : at == SliceAt::top ? 3.75 : 4.0);
        EXPECT_EQ(plan.layers[0].top, plan.layers[0].bottom + 0.5);
    }
    const Plan usual = plan_listed({4.25}, SliceAt::bottom);
    EXPECT_EQ(usual.layers[0].top, 4.25 + UniformLayers{}.layer_height);
    expect_error(ErrorKind::usage, {"layer height"}, [] { (void)plan_listed({1}, SliceAt::middle, 0); });
}

TEST(PlanListed, TakesNeighboursAsNearAsDoublesGo) {
    const double z = 1.0;
    const Plan plan = plan_listed({z, std::nextafter(z, 2.0)});
    EXPECT_EQ(plan.layers.size(), 2U);
    expect_sound(plan);
}

TEST(PlanListed, RefusesLayersWhoseBottomAndTopAreOneNumber) {
    for (const SliceAt at : everywhere)
        expect_error(ErrorKind::usage, {"a layer of 0.1 mm", "around 1e+20 mm"},
                     [&] { (void)plan_listed({1e20}, at, 0.1); });
    const double next = std::nextafter(1.0, 2.0);
    expect_error(ErrorKind::usage, {"too low", "around 1.0000000000000004 mm"}, [&] {
        (void)plan_listed({1, next, std::nextafter(next, 2.0)});
    });
}

TEST(PlanListed, RefusesAnEmptyList) {
    expect_error(ErrorKind::usage, {"holds no number"}, [] { (void)plan_listed({}); });
}

TEST(PlanListed, NamesTheFirstNumberThatDoesNotAscend) {
    expect_error(ErrorKind::usage, {"number 3", "0.5", "0.75"}, [] { (void)plan_listed({0, 0.75, 0.5, 0}); });
    expect_error(ErrorKind::usage, {"number 2", "1"}, [] { (void)plan_listed({1, 1}); });
    expect_error(ErrorKind::usage, {"number 2"}, [] { (void)plan_listed({0.0, -0.0}); });
}

TEST(PlanListed, RefusesCutsFurtherApartThanADoubleCanSay) {
    expect_error(ErrorKind::usage, {"-1.7e+308", "1.7e+308"}, [] {
        (void)plan_listed({-1.7e308, 0, 1.7e308});
    });
    EXPECT_EQ(plan_listed({-8e307, 0, 8e307}).layers.size(), 3U);
    // The lowest layer would begin at twice that.
    expect_error(ErrorKind::usage, {"-1.7e+308", "0.5"}, [] { (void)plan_listed({-1.7e308, 0.5}); });
    expect_error(ErrorKind::usage, {"1.7e+308"},
                 [] { (void)plan_listed({1.7e308}, SliceAt::bottom, 1.7e308); });
    EXPECT_EQ(plan_listed({-1.7e308, 0.5}, SliceAt::bottom).layers[1].top, 1.7e308);
}

TEST(PlanListed, NamesTheFirstNumberThatIsNotFinite) {
    expect_error(ErrorKind::usage, {"number 1", "finite"}, [] { (void)plan_listed({nan}); });
    expect_error(ErrorKind::usage, {"number 2", "finite"}, [] { (void)plan_listed({0, infinity}); });
    expect_error(ErrorKind::usage, {"number 1", "finite"}, [] { (void)plan_listed({-infinity, 1}); });
    expect_error(ErrorKind::usage, {"number 3", "finite"}, [] { (void)plan_listed({0, 1, nan, 2}); });
}

} // namespace
} // namespace lamella
