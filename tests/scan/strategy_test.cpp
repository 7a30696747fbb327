#include "lamella/core/error.hpp"
#include "lamella/scan/strategy.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace lamella::strategy_cases {
namespace {

TEST(Strategy, IsRightAsItIsPreset) {
    EXPECT_NO_THROW(check_strategy({}));
}

TEST(Strategy, RefusesValuesOutOfRangeAndNamesTheirField) {
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    constexpr double infinite = std::numeric_limits<double>::infinity();
    struct Bad {
        std::string field;
        std::function<void(ScanStrategy&)> spoil;
    };
    const std::vector<Bad> all{
        {"`hatch.distance`",
         [](ScanStrategy& s) {
             s.hatch.distance = 0;
         }},
        {"`hatch.distance`",
         [](ScanStrategy& s) {
             s.hatch.distance = -0.1;
         }},
        {"`hatch.distance`",
         [](ScanStrategy& s) {
             s.hatch.distance = nan;
         }},
        {"`hatch.angle_degrees`",
         [](ScanStrategy& s) {
             s.hatch.angle_degrees = infinite;
         }},
        {"`hatch.turn_degrees`",
         [](ScanStrategy& s) {
             s.hatch.turn_degrees = nan;
         }},
        {"`hatch.border`",
         [](ScanStrategy& s) {
             s.hatch.border = -1;
         }},
        {"`hatch.shortest`",
         [](ScanStrategy& s) {
             s.hatch.shortest = -1;
         }},
        {"`hatch.cell`",
         [](ScanStrategy& s) {
             s.hatch.cell = 0;
         }},
        {"`hatch.overlap`",
         [](ScanStrategy& s) {
             s.hatch.overlap = -0.1;
         }},
        {"`hatch.cell`",
         [](ScanStrategy& s) {
             s.hatch.overlap = s.hatch.cell / 2;
         }},
        {"`hatch.cell`",
         [](ScanStrategy& s) {
             s.hatch.shortest = s.hatch.cell;
         }},
        {"`upskin.hatch.cell`",
         [](ScanStrategy& s) {
             s.upskin.hatch.pattern = HatchPattern::hexagons;
             s.upskin.hatch.shortest = s.upskin.hatch.cell + 1;
         }},
        {"`hatch.speed_mm_s`",
         [](ScanStrategy& s) {
             s.hatch.parameters.speed_mm_s = 0;
         }},
        {"`upskin.layers`",
         [](ScanStrategy& s) {
             s.upskin.layers = most_skin_layers + 1;
         }},
        {"`downskin.overlap`",
         [](ScanStrategy& s) {
             s.downskin.overlap = -1;
         }},
        {"`downskin.hatch.distance`",
         [](ScanStrategy& s) {
             s.downskin.hatch.distance = 0;
         }},
        {"`contours.count`",
         [](ScanStrategy& s) {
             s.contours.count = most_contours + 1;
         }},
        {"`contours.distance`",
         [](ScanStrategy& s) {
             s.contours.distance = 0;
         }},
        {"`contours.beam_offset`",
         [](ScanStrategy& s) {
             s.contours.beam_offset = -0.1;
         }},
        {"`contours.power_w`",
         [](ScanStrategy& s) {
             s.contours.parameters.power_w = infinite;
         }},
        {"`support.contours.count`",
         [](ScanStrategy& s) {
             s.support.contours.count = most_contours + 1;
         }},
        {"`support.hatch.distance`",
         [](ScanStrategy& s) {
             s.support.hatch.distance = 0;
         }},
    };
    for (const Bad& bad : all) {
        ScanStrategy strategy;
        bad.spoil(strategy);
        try {
            check_strategy(strategy);
            ADD_FAILURE() << bad.field;
        } catch (const Error& error) {
            EXPECT_EQ(error.kind(), ErrorKind::usage);
            EXPECT_NE(std::string(error.what()).find(bad.field), std::string::npos) << error.what();
        }
    }
}

TEST(Strategy, OfPatternsWithoutCellsMayAskForLinesLongerThanThese) {
    ScanStrategy strategy;
    strategy.hatch.shortest = 100;
    for (const HatchPattern pattern : {HatchPattern::lines, HatchPattern::meander}) {
        strategy.hatch.pattern = pattern;
        EXPECT_NO_THROW(check_strategy(strategy));
    }
}

TEST(Strategy, ReportsWhatIsExposedInItsOrder) {
    ScanStrategy strategy;
    const auto names = [&] {
        std::string all;
        for (const Exposure& exposure : exposures(strategy, "bracket")) {
            EXPECT_EQ(exposure.part, "bracket");
            all += (all.empty() ? "" : ", ") + exposure.name();
        }
        return all;
    };
    EXPECT_EQ(names(), "core hatch, core contour 1");
    strategy.contours.count = 2;
    EXPECT_EQ(names(), "core hatch, core contour 2, core contour 1");
    strategy.contours.order = ContourOrder::outside_in;
    strategy.contours.before_hatch = true;
    strategy.upskin.layers = strategy.downskin.layers = 3;
    EXPECT_EQ(names(), "core contour 1, core contour 2, downskin hatch, core hatch, upskin hatch");
    strategy.contours.count = 0;
    EXPECT_EQ(names(), "downskin hatch, core hatch, upskin hatch");
}

TEST(Strategy, HasRulesOfTheirOwnForSupports) {
    ScanStrategy strategy;
    strategy.upskin.layers = strategy.downskin.layers = 3;
    strategy.support.contours.count = 2;
    strategy.support.contours.before_hatch = true;
    strategy.support.hatch.parameters.name = "coarse";
    const std::vector<Exposure> found = support_exposures(strategy, "foot");
    ASSERT_EQ(found.size(), 3U);
    EXPECT_EQ(found[0].name(), "support contour 2");
    EXPECT_EQ(found[1].name(), "support contour 1");
    EXPECT_EQ(found[2].name(), "support hatch");
    EXPECT_EQ(found[2].part, "foot");
    EXPECT_EQ(found[1].parameters, strategy.support.contours.parameters);
    EXPECT_EQ(found[2].parameters, strategy.support.hatch.parameters);
}

TEST(Strategy, AsksNothingOfCellsThatAPatternHasNot) {
    ScanStrategy strategy;
    strategy.hatch.cell = 0.1;
    EXPECT_THROW(check_strategy(strategy), Error);
    for (const HatchPattern pattern : {HatchPattern::lines, HatchPattern::meander}) {
        strategy.hatch.pattern = pattern;
        EXPECT_NO_THROW(check_strategy(strategy));
    }
}

} // namespace
} // namespace lamella::strategy_cases
