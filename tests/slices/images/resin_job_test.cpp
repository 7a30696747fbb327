#include "slices/images/resin_job.hpp"
#include "slices/images/resin_plan.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace lamella::resin_job_cases {
namespace {

LayerStack planes_of(std::size_t count) {
    LayerStack planes;
    for (std::size_t i = 0; i < count; ++i)
        planes.push_back({.index = i,
                          .z = 3.05 + 0.1 * static_cast<double>(i),
                          .bottom = 3 + 0.1 * static_cast<double>(i),
                          .top = 3.1 + 0.1 * static_cast<double>(i)});
    return planes;
}

std::vector<double> exposures_by(const ResinSettings& settings, const LayerStack& planes) {
    const ResinPlan plan(settings, {});
    std::vector<double> exposures;
    for (std::size_t i = 0; i < planes.size(); ++i)
        exposures.push_back(plan.exposure_s(i, planes[i].z - planes.front().bottom));
    return exposures;
}

TEST(ResinJob, KeepsTheExposureOfEachLayer) {
    const LayerStack planes = planes_of(9);
    const ResinSettings rule{
        .exposure_s = 2, .bottom_exposure_s = 30, .bottom_layers = 2, .transition_layers = 3};
    ResinJob job{.settings = rule};
    job.exposures_s = exposures_by(rule, planes);
    EXPECT_TRUE(settings_of(job, planes).ranges.empty()) << "the rule gives them";
    job.exposures_s = {30, 30, 30, 25, 4, 2, 2, 2.5, 2.5};
    const ResinSettings settings = settings_of(job, planes);
    EXPECT_EQ(settings.ranges.size(), 4U);
    EXPECT_EQ(exposures_by(settings, planes), job.exposures_s);
}

TEST(ResinJob, KnowsTheTransitionThatTheExposuresOfLayersHave) {
    const LayerStack planes = planes_of(12);
    for (const std::uint32_t layers : {0U, 1U, 3U, 9U}) {
        ResinSettings rule{
            .exposure_s = 2.7, .bottom_exposure_s = 30, .bottom_layers = 2, .transition_layers = layers};
        ResinJob job{.settings = rule};
        job.exposures_s = exposures_by(rule, planes);
        job.settings.transition_layers = 0; // as files say in which each layer has its own exposure
        ResinSettings settings = settings_of(job, planes);
        EXPECT_EQ(settings.transition_layers, layers);
        EXPECT_TRUE(settings.ranges.empty());
        settings.exposure_s = 2; // as an option replaces it
        rule.exposure_s = 2;
        EXPECT_EQ(exposures_by(settings, planes), exposures_by(rule, planes));
    }
}

TEST(ResinJob, HasSettingsThatPrintersCanFollow) {
    ResinSettings zeros{.exposure_s = 0,
                        .bottom_exposure_s = std::numeric_limits<double>::quiet_NaN(),
                        .light_off_s = -1,
                        .light_power = 1000,
                        .density_g_ml = 0,
                        .currency = "much too long"};
    zeros.travel = {.lift_mm = 1,
                    .lift_mm_min = 0,
                    .lift2_mm_min = 0,
                    .retract_mm_min = -3,
                    .retract2_mm = 5,
                    .retract2_mm_min = 0};
    EXPECT_ANY_THROW(check_resin_settings(zeros));
    const ResinSettings usable = usable_settings(zeros);
    EXPECT_NO_THROW(check_resin_settings(usable));
    EXPECT_FALSE(usable.exposure_s);
    EXPECT_EQ(usable.travel.lift_mm, 1);
    EXPECT_EQ(usable.travel.retract2_mm, 1);
    EXPECT_EQ(usable_settings(usable).travel, usable.travel);
}

} // namespace
} // namespace lamella::resin_job_cases
