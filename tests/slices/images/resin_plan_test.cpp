#include "fixtures/any_printer.hpp"
#include "fixtures/expect_error.hpp"
#include "slices/images/resin_plan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

namespace lamella::resin_plan_cases {
namespace {

TEST(ResinPlan, FadesFromTheBottomToTheOtherLayers) {
    // The numbers of a file by CHITUBOX for an Elegoo Saturn, and of one by Photon Workshop for a Mono X.
    const ResinPlan saturn(
        {.exposure_s = 2.5, .bottom_exposure_s = 30, .bottom_layers = 5, .transition_layers = 10}, {});
    EXPECT_EQ(saturn.exposure_s(0, 0), 30);
    EXPECT_EQ(saturn.exposure_s(4, 0), 30);
    EXPECT_DOUBLE_EQ(saturn.exposure_s(8, 0), 20);
    EXPECT_EQ(saturn.exposure_s(15, 0), 2.5);
    EXPECT_EQ(saturn.exposure_s(50, 0), 2.5);
    const ResinPlan mono(
        {.exposure_s = 2, .bottom_exposure_s = 28, .bottom_layers = 4, .transition_layers = 10}, {});
    EXPECT_FLOAT_EQ(static_cast<float>(mono.exposure_s(8, 0)), 16.181818F);
}

TEST(ResinPlan, TakesFromThePrinterWhatIsNotGiven) {
    const ResinPlan plan({.exposure_s = 4}, test::any_printer);
    EXPECT_EQ(plan.exposure_s(), 4);
    EXPECT_EQ(plan.bottom_exposure_s(), 30);
    EXPECT_EQ(plan.bottom_layers(), 3U);
    EXPECT_EQ(plan.transition_layers(), 2U);
}

TEST(ResinPlan, GivesRangesTheirOwnExposure) {
    const ResinPlan plan({.exposure_s = 2, .ranges = {{0, 1, 10}, {0.5, 2, 20}}}, test::any_printer);
    EXPECT_EQ(plan.exposure_s(0, 0.025), 10);
    EXPECT_EQ(plan.exposure_s(12, 0.5), 20);
    EXPECT_EQ(plan.exposure_s(12, 2), 2);
}

TEST(ResinPlan, AddsUpTheTimeOfALayer) {
    const PlateTravel travel{.lift_mm = 3,
                             .lift_mm_min = 60,
                             .lift2_mm = 4,
                             .lift2_mm_min = 240,
                             .retract_mm_min = 120,
                             .retract2_mm = 1,
                             .retract2_mm_min = 30,
                             .wait_before_lift_s = 0.25,
                             .wait_after_lift_s = 0.5,
                             .wait_after_retract_s = 1};
    ResinSettings settings{.travel = travel};
    EXPECT_DOUBLE_EQ(ResinPlan(settings, test::any_printer).layer_time_s(3, 2, false),
                     2 + 3 + 1 + 3 + 2 + 0.25 + 0.5 + 1);
    settings.light_off_s = 6;
    EXPECT_DOUBLE_EQ(ResinPlan(settings, test::any_printer).layer_time_s(3, 2, false), 2 + 3 + 1 + 3 + 2 + 6);
    ResinPrinter tilting = test::any_printer;
    tilting.small_pause_s = 5;
    tilting.large_pause_s = 8;
    EXPECT_EQ(ResinPlan(settings, tilting).layer_time_s(3, 2, true), 10);
    EXPECT_EQ(ResinPlan(settings, tilting).layer_time_s(3, 2, false), 7);
    const PlateTravel whole = in_one_stage(travel);
    EXPECT_EQ(whole.lift_mm, 7);
    EXPECT_EQ(whole.lift_mm_min, 60);
    EXPECT_EQ(whole.retract_mm_min, 30);
    EXPECT_EQ(retract_mm_of(whole), 7);
    EXPECT_EQ(in_one_stage(PlateTravel{}), PlateTravel{});
}

TEST(ResinPlan, KnowsWhatTheResinWeighsAndCosts) {
    const ResinPlan plan({.density_g_ml = 1.2, .price_per_litre = 40}, test::any_printer);
    EXPECT_DOUBLE_EQ(plan.mass_g(5), 6);
    EXPECT_DOUBLE_EQ(plan.price(5), 0.2);
}

TEST(ResinPlan, RefusesWhatNoPrinterCanDo) {
    const auto refuse = [](const char* text, const std::function<void(ResinSettings&)>& change) {
        ResinSettings settings;
        change(settings);
        test::expect_error(ErrorKind::usage, {text},
                           [&] { static_cast<void>(ResinPlan(settings, test::any_printer)); });
    };
    refuse("an exposure of 0 s", [](ResinSettings& s) { s.exposure_s = 0; });
    refuse("a bottom exposure of inf s",
           [](ResinSettings& s) { s.bottom_exposure_s = std::numeric_limits<double>::infinity(); });
    refuse("a lift of -1 mm", [](ResinSettings& s) { s.travel.lift_mm = -1; });
    refuse("a lift speed of 0 mm/min", [](ResinSettings& s) { s.bottom_travel.lift_mm_min = 0; });
    refuse("a second retract of 6 mm: choose at most the 5 mm of the lift",
           [](ResinSettings& s) { s.travel.retract2_mm = 6; });
    refuse("a wait after the lift of nan s",
           [](ResinSettings& s) { s.travel.wait_after_lift_s = std::nan(""); });
    refuse("a light power of 256", [](ResinSettings& s) { s.light_power = 256; });
    refuse("a density of 0", [](ResinSettings& s) { s.density_g_ml = 0; });
    refuse("a price of -1", [](ResinSettings& s) { s.price_per_litre = -1; });
    refuse("a currency of 8 bytes", [](ResinSettings& s) { s.currency = "guilders"; });
    refuse("a range of heights from 2 to 2 mm", [](ResinSettings& s) { s.ranges = {{2, 2, 1}}; });
    refuse("an exposure of a range of 0 s", [](ResinSettings& s) { s.ranges = {{1, 2, 0}}; });
}

TEST(UtcText, NamesDateAndTime) {
    EXPECT_EQ(utc_text(0, " at "), "1970-01-01 at 00:00:00");
    EXPECT_EQ(utc_text(1'796'054'401, " "), "2026-11-30 16:00:01");
}

} // namespace
} // namespace lamella::resin_plan_cases
