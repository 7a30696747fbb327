#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/layer_steps.hpp"

#include "fixtures/expect_error.hpp"
#include "fixtures/layers.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <utility>

namespace lamella {
namespace {

using test::layer_of;
using test::rectangle;
using test::reversed;

TEST(LayerSteps, NoneChangesNothing) {
    const Layer layer = layer_of({rectangle(0, 0, 4, 4), rectangle(2, 2, 6, 6)});
    const ChangedLayer same = take_steps({}, layer);
    EXPECT_EQ(same.layer.points.data(), layer.points.data());
    EXPECT_EQ(same.changes.changed_layers, 0U);
}

TEST(LayerSteps, ThatAreImpossibleAreRefusedWhateverTheLayer) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const LayerSteps& steps :
         {LayerSteps{.offset_mm = nan}, LayerSteps{.offset_mm = -1, .offset_corners = {.mitre_limit = 0}},
          LayerSteps{.min_area_mm2 = nan}, LayerSteps{.min_area_mm2 = -1}, LayerSteps{.simplify_mm = nan},
          LayerSteps{.simplify_mm = -1}}) {
        EXPECT_TRUE(steps.any());
        test::error_of(ErrorKind::usage, [&] { check_steps(steps); });
        test::error_of(ErrorKind::usage, [&] { static_cast<void>(take_steps(steps, Layer{})); });
        test::error_of(ErrorKind::usage,
                       [&] { static_cast<void>(take_steps(steps, std::vector<LayerStack>{})); });
    }
    check_steps({.offset_mm = -1, .min_area_mm2 = 1, .simplify_mm = 0.1});
}

TEST(LayerSteps, ShrinkTheFirstLayersLessAndLess) {
    LayerSteps steps{.offset_mm = 0.1, .bottom = {.inset_mm = 0.4, .height_mm = 2, .plate_mm = -1}};
    const Layer tube = normal_form(layer_of({rectangle(0, 0, 8, 8), reversed(rectangle(2, 2, 6, 6))}));
    for (const auto& [z, distance] :
         {std::pair{-2.0, -0.3}, {-1.0, -0.3}, {0.0, -0.1}, {0.5, 0.0}, {1.0, 0.1}, {9.0, 0.1}}) {
        EXPECT_NEAR(steps.offset_at(z), distance, 1e-15);
        Layer layer = tube;
        layer.z = z;
        const Layer expected = offset(layer, steps.offset_at(z));
        EXPECT_TRUE(same_contours(take_steps(steps, layer).layer, expected)) << z;
    }
    for (const BottomInset& impossible :
         {BottomInset{.inset_mm = 1}, BottomInset{.inset_mm = -1, .height_mm = 1},
          BottomInset{.inset_mm = 0, .height_mm = 1}})
        test::error_of(ErrorKind::usage, [&] { check_steps({.bottom = impossible}); });
}

TEST(LayerSteps, AreTakenInOrderAndReportedAbout) {
    const Layer layer = normal_form(layer_of({rectangle(0, 0, 4, 4), rectangle(2, 0, 6, 4),
                                              reversed(rectangle(0.5, 0.5, 1, 1)), rectangle(20, 0, 22, 2)}));
    LayerSteps steps;
    steps.fill = FillRule::nonzero;
    steps.offset_mm = 1;
    steps.largest_only = true;
    steps.simplify_mm = 0.01;
    const auto [result, changes] = take_steps(steps, layer);
    EXPECT_TRUE(same_contours(result, layer_of({rectangle(-1, -1, 7, 5)})));
    EXPECT_EQ(changes.changed_layers, 1U);
    EXPECT_EQ(changes.groups_united, 1U);
    EXPECT_EQ(changes.rings_united, 2U);
    EXPECT_EQ(changes.rings_dropped, 1U); // the body beside; the hole was closed by growing
    EXPECT_DOUBLE_EQ(changes.area_before_mm2, 16 + 16 - 0.25 + 4);
    EXPECT_DOUBLE_EQ(changes.area_after_mm2, 48);
    LayerChanges sum = changes;
    sum += changes;
    EXPECT_EQ(sum.rings_united, 4U);
    EXPECT_DOUBLE_EQ(sum.area_after_mm2, 96);
}

TEST(LayerSteps, ReportHowManyRingsAnOffsetLeavesNothingOf) {
    const Layer frame = normal_form(
        layer_of({rectangle(0, 0, 10, 10), reversed(rectangle(1, 1, 9, 9)), rectangle(20, 0, 30, 10)}));
    const auto vanished = [&](double distance) {
        return take_steps({.offset_mm = distance}, frame).changes.rings_vanished;
    };
    EXPECT_EQ(vanished(0.4), 0U);
    EXPECT_EQ(vanished(-0.4), 0U);
    EXPECT_EQ(vanished(4.1), 1U) << "growing closes the hole";
    EXPECT_EQ(vanished(-0.6), 2U) << "walls of 1 mm are gone, with the hole within them";
    EXPECT_EQ(vanished(-100), 3U);
}

TEST(LayerSteps, APlaneCountsOnceHoweverManyPartsChangeOnIt) {
    const Layer small = normal_form(layer_of({rectangle(0, 0, 1, 1), rectangle(5, 0, 9, 4)}));
    const Layer large = normal_form(layer_of({rectangle(0, 0, 4, 4)}));
    const LayerSteps steps{.min_area_mm2 = 2};
    const ChangedPlane plane = take_steps_on_plane(steps, std::vector{small, small, large});
    ASSERT_EQ(plane.parts.size(), 3U);
    EXPECT_EQ(plane.parts[1].rings, 1U);
    EXPECT_EQ(plane.changes.changed_layers, 1U);
    EXPECT_EQ(plane.changes.rings_dropped, 2U);

    const auto [parts, planes] =
        take_steps(steps, std::vector<LayerStack>{{small, large, small}, {small, large, large}},
                   {.execution = {.threads = 2}});
    ASSERT_EQ(planes.size(), 3U);
    const std::uint64_t changed[] = {1, 0, 1};
    const std::uint64_t dropped[] = {2, 0, 1};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(planes[i].changed_layers, changed[i]);
        EXPECT_EQ(planes[i].rings_dropped, dropped[i]);
        EXPECT_EQ(parts[0][i].rings, 1U);
        EXPECT_EQ(parts[1][i].rings, 1U);
    }
}

TEST(LayerSteps, SmallRingsAreDroppedWhenAskedFor) {
    const Layer layer = normal_form(layer_of({rectangle(0, 0, 4, 4), reversed(rectangle(1, 1, 2, 2))}));
    LayerSteps steps;
    steps.min_area_mm2 = 2;
    const auto [result, changes] = take_steps(steps, layer);
    EXPECT_TRUE(same_contours(result, layer_of({rectangle(0, 0, 4, 4)})));
    EXPECT_EQ(changes.rings_dropped, 1U);
    EXPECT_DOUBLE_EQ(changes.area_after_mm2 - changes.area_before_mm2, 1);
}

} // namespace
} // namespace lamella
