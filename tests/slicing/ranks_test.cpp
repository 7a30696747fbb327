#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"
#include "slicing/ranks.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

namespace lamella::ranks_cases {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double largest = std::numeric_limits<double>::max();

Plan plan_of(std::vector<double> z, PlaneRule rule) {
    std::sort(z.begin(), z.end());
    z.erase(std::unique(z.begin(), z.end()), z.end());
    Plan plan;
    plan.rule = rule;
    for (std::size_t i = 0; i < z.size(); ++i)
        plan.layers.push_back({i, z[i], z[i], z[i]});
    return plan;
}

std::uint32_t count_below(const Plan& plan, double z) {
    return static_cast<std::uint32_t>(
        std::count_if(plan.layers.begin(), plan.layers.end(), [&](const PlannedLayer& layer) {
            return plan.rule == PlaneRule::section_above ? layer.z < z : layer.z <= z;
        }));
}

/// Compares with counting, for every plane, its neighbours among doubles and the middles between planes.
void expect_counts(const std::vector<double>& z, const std::vector<double>& more = {}) {
    for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below}) {
        const Plan plan = plan_of(z, rule);
        const Ranks ranks(plan);
        ASSERT_EQ(ranks.count(), plan.layers.size());
        EXPECT_EQ(ranks.rule(), rule);
        std::vector<double> probes{-largest, -1, -0.0, 0.0, 1, largest};
        probes.insert(probes.end(), more.begin(), more.end());
        for (std::size_t i = 0; i < plan.layers.size(); ++i) {
            const double plane = plan.layers[i].z;
            EXPECT_EQ(ranks.z(static_cast<std::uint32_t>(i)), plane);
            probes.insert(probes.end(),
                          {plane, std::nextafter(plane, -infinity), std::nextafter(plane, infinity)});
            if (i > 0)
                probes.push_back(plan.layers[i - 1].z / 2 + plane / 2);
        }
        for (const double probe : probes)
            ASSERT_EQ(ranks(probe), count_below(plan, probe)) << "z = " << probe;
    }
}

TEST(Ranks, OfNoPlanesAreZero) {
    expect_counts({});
}

TEST(Ranks, DistinguishASinglePlaneFromItsNeighbours) {
    for (const double z : {0.0, -1.5, 1e300, 5e-324, -largest})
        expect_counts({z}, {z - 1, z + 1});
}

TEST(Ranks, CountEvenlySpacedPlanes) {
    std::vector<double> z;
    for (int i = 0; i < 300; ++i)
        z.push_back(-7 + i * 0.1);
    test::Random random(2);
    std::vector<double> probes(2000);
    for (double& probe : probes)
        probe = random.real(-8, 24);
    expect_counts(z, probes);
}

TEST(Ranks, CountHeightsWithinTheSnapDistanceOfAPlaneAsOnIt) {
    test::Random random(4);
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> z(static_cast<std::size_t>(random.integer(1, 40)));
        for (double& plane : z)
            plane = random.real(-8, 8);
        for (const PlaneRule rule : {PlaneRule::section_above, PlaneRule::section_below}) {
            Plan plan = plan_of(z, rule);
            for (PlannedLayer& layer : plan.layers) // without a height, so that any distance is permitted
                layer.bottom = layer.top = layer.z;
            plan.snap_mm = random.real(0, 1); // often more than what lies between planes
            const Ranks ranks(plan);
            EXPECT_EQ(ranks.snap_mm(), plan.snap_mm);
            std::vector<double> probes{-9, 9};
            for (const PlannedLayer& layer : plan.layers)
                probes.insert(probes.end(),
                              {layer.z, layer.z + 0.999 * plan.snap_mm, layer.z - 0.999 * plan.snap_mm,
                               layer.z + 1.001 * plan.snap_mm, layer.z - 1.001 * plan.snap_mm});
            for (const double probe : probes) {
                const auto below =
                    std::count_if(plan.layers.begin(), plan.layers.end(), [&](const PlannedLayer& layer) {
                        return rule == PlaneRule::section_above ? layer.z + plan.snap_mm < probe
                                                                : layer.z - plan.snap_mm <= probe;
                    });
                ASSERT_EQ(ranks(probe), static_cast<std::uint32_t>(below)) << "z = " << probe;
            }
        }
    }
}

TEST(Ranks, RefuseWhatIsNoPlan) {
    const Plan ascending = plan_of({1, 2, 3}, PlaneRule::section_above);
    const auto expect_refused = [&](const char* words, auto&& change) {
        Plan plan = ascending;
        change(plan);
        test::expect_error(ErrorKind::usage, {words}, [&] { check(plan); });
        test::expect_error(ErrorKind::usage, {words}, [&] { (void)Ranks(plan); });
    };
    EXPECT_NO_THROW(check(ascending));
    EXPECT_NO_THROW(check(Plan{}));
    expect_refused("layer 2 of the plan is cut at z = 2 mm, which is not above the one before it, 2",
                   [](Plan& plan) { plan.layers[2].z = 2; });
    expect_refused("layer 1 of the plan", [](Plan& plan) { std::swap(plan.layers[0], plan.layers[1]); });
    expect_refused(
        "layer 1 of the plan is cut at z = 2 mm, which is not between its bottom, 2.5, and its top, 3",
        [](Plan& plan) {
            plan.layers[1].bottom = 2.5;
            plan.layers[1].top = 3;
        });
    expect_refused(
        "layer 0 of the plan is cut at z = 1 mm, which is not between its bottom, 0, and its top, 0",
        [](Plan& plan) { plan.layers[0] = {.index = 0, .z = 1}; });
    expect_refused("layer 1 of the plan: found a height of nan mm",
                   [](Plan& plan) { plan.layers[1].z = std::nan(""); });
    expect_refused("layer 2 of the plan: found a height of inf mm",
                   [](Plan& plan) { plan.layers[2].top = infinity; });
    expect_refused("the snap distance is -1 mm", [](Plan& plan) { plan.snap_mm = -1; });
    expect_refused("the snap distance is nan mm", [](Plan& plan) { plan.snap_mm = std::nan(""); });
    expect_refused("the snap distance is 0.25 mm, half of the layer height or more: layer 1 is 0.5 mm high",
                   [](Plan& plan) {
                       plan.layers[1] = {.index = 1, .z = 2, .bottom = 1.75, .top = 2.25};
                       plan.snap_mm = 0.25;
                   });
}

TEST(Ranks, CountRandomPlanes) {
    test::Random random(3);
    for (int trial = 0; trial < 30; ++trial) {
        std::vector<double> z(static_cast<std::size_t>(random.integer(1, 200)));
        for (double& plane : z)
            plane = random.real(-50, 50);
        std::vector<double> probes(300);
        for (double& probe : probes)
            probe = random.real(-51, 51);
        expect_counts(z, probes);
    }
}

TEST(Ranks, CountPlanesThatCrowdInAFewPlaces) {
    test::Random random(4);
    for (const double crowd : {1e-3, 1e-9, 1e-14}) {
        std::vector<double> z{-1000, 1000};
        for (int i = 0; i < 200; ++i)
            z.push_back(static_cast<double>(random.integer(0, 2)) + random.real(0, crowd));
        expect_counts(z);
    }
}

TEST(Ranks, CountPlanesThatAreNeighboursAmongDoubles) {
    for (const double start : {0.0, 1.0, -1.0, 1e-308, 123456.789}) {
        std::vector<double> z{start};
        for (int i = 0; i < 50; ++i)
            z.push_back(std::nextafter(z.back(), infinity));
        expect_counts(z);
    }
}

TEST(Ranks, CountPlanesOfAnySize) {
    for (const double unit : {5e-324, 1e-310, 1e-300, 1e-30, 1e30, 1e300, 1.7e306}) {
        std::vector<double> z;
        for (int i = 0; i < 100; ++i)
            z.push_back(unit * i);
        expect_counts(z);
    }
}

TEST(Ranks, NeverFallAsHeightsRise) {
    test::Random random(5);
    std::vector<double> z(1000);
    for (double& plane : z)
        plane = std::ldexp(random.real(-1, 1), static_cast<int>(random.integer(-40, 10)));
    const Ranks ranks(plan_of(z, PlaneRule::section_above));
    std::vector<double> probes(5000);
    for (double& probe : probes)
        probe = std::ldexp(random.real(-1, 1), static_cast<int>(random.integer(-41, 11)));
    std::sort(probes.begin(), probes.end());
    for (std::size_t i = 1; i < probes.size(); ++i)
        ASSERT_LE(ranks(probes[i - 1]), ranks(probes[i]));
}

} // namespace
} // namespace lamella::ranks_cases
