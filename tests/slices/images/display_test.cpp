#include "fixtures/expect_error.hpp"
#include "slices/images/display.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace lamella {
namespace {

Box3 box(double x0, double y0, double x1, double y1) {
    return {{x0, y0, 0}, {x1, y1, 1}};
}

ResinPrinter printer() {
    return {.name = "P", .pixels = {200, 100}, .display_mm = {20, 10}, .portrait = true, .mirror_x = true};
}

void expect_refusal(const char* text, const Box3& part, const ImageOptions& options,
                    const ResinPrinter& by = {}) {
    test::expect_error(ErrorKind::usage, {text}, [&] { static_cast<void>(display_for(part, options, by)); });
}

TEST(Display, HasAsManyPixelsAsThePartNeedsUnlessReportedOtherwise) {
    const Display display = display_for(box(-3, 100, 7, 102.01), {}, {});
    EXPECT_EQ(display.pixels.x, 200U);
    EXPECT_EQ(display.pixels.y, 41U);
    EXPECT_EQ(display.pixel_mm.x, 0.05);
    EXPECT_EQ(display.pixel_mm.y, 0.05);
    const Display point = display_for(box(1, 1, 1, 1), {}, {});
    EXPECT_EQ(point.pixels.x, 1U);
    EXPECT_EQ(point.pixels.y, 1U);
}

TEST(Display, FollowsFromTwoOfSizeNumberAndPixel) {
    const Box3 part = box(0, 0, 5, 5);
    for (const ImageOptions& options :
         {ImageOptions{.pixel_mm = {{0.1, 0.2}}, .pixels = {{100, 200}}},
          ImageOptions{.pixel_mm = {{0.1, 0.2}}, .display_mm = {{10, 40}}},
          ImageOptions{.pixels = {{100, 200}}, .display_mm = {{10, 40}}},
          ImageOptions{.pixel_mm = {{0.1, 0.2}}, .pixels = {{100, 200}}, .display_mm = {{10, 40}}}}) {
        const Display display = display_for(part, options, {});
        EXPECT_EQ(display.pixels.x, 100U);
        EXPECT_EQ(display.pixels.y, 200U);
        EXPECT_DOUBLE_EQ(display.pixel_mm.x, 0.1);
        EXPECT_DOUBLE_EQ(display.pixel_mm.y, 0.2);
    }
}

TEST(Display, TakesFromThePrinterWhatIsNotGiven) {
    const Box3 part = box(0, 0, 5, 5);
    const Display whole = display_for(part, {}, printer());
    EXPECT_EQ(whole.pixels.x, 200U);
    EXPECT_DOUBLE_EQ(whole.pixel_mm.y, 0.1);
    EXPECT_TRUE(whole.portrait);
    EXPECT_TRUE(whole.mirror_x);
    EXPECT_FALSE(whole.mirror_y);
    EXPECT_DOUBLE_EQ(display_for(part, {.pixel_mm = {{0.05, 0.06}}}, printer()).height_mm(), 6);
    EXPECT_DOUBLE_EQ(display_for(part, {.pixels = {{400, 200}}}, printer()).pixel_mm.x, 0.05);
    EXPECT_DOUBLE_EQ(display_for(part, {.display_mm = {{40, 20}}}, printer()).pixel_mm.x, 0.2);
    EXPECT_FALSE(display_for(part, {.portrait = false}, printer()).portrait);
    EXPECT_FALSE(display_for(part, {.mirror_x = false}, printer()).mirror_x);
}

TEST(Display, ShowsThePartInItsMiddleWhicheverWayItIsHeld) {
    const Box3 part = box(30, -8, 36, -4);
    for (int way = 0; way < 8; ++way) {
        const Display display = display_for(part,
                                            {.pixels = {{200, 100}},
                                             .display_mm = {{20, 20}},
                                             .portrait = (way & 1) != 0,
                                             .mirror_x = (way & 2) != 0,
                                             .mirror_y = (way & 4) != 0},
                                            {});
        const PixelGrid grid = display.grid(part);
        EXPECT_EQ(grid.width, display.portrait ? 100U : 200U);
        EXPECT_EQ(grid.height, display.portrait ? 200U : 100U);
        EXPECT_DOUBLE_EQ(grid.ux * 33 + grid.uy * -6 + grid.u0, 0.5 * grid.width);
        EXPECT_DOUBLE_EQ(grid.vx * 33 + grid.vy * -6 + grid.v0, 0.5 * grid.height);
    }
}

TEST(Display, IsHeldAsPrusaSlicerHoldsIt) {
    // Where the corner at the lower left of the display appears in the picture: its column and row.
    struct Way {
        bool portrait, mirror_x, mirror_y;
        double column, row;
    };
    for (const Way& way :
         {Way{false, false, false, 0, 100}, Way{false, true, false, 200, 100}, Way{false, false, true, 0, 0},
          Way{false, true, true, 200, 0}, Way{true, false, false, 100, 200}, Way{true, true, false, 0, 200},
          Way{true, false, true, 100, 0}, Way{true, true, true, 0, 0}}) {
        const Box3 all = box(0, 0, 20, 10);
        const PixelGrid grid = display_for(all,
                                           {.pixels = {{200, 100}},
                                            .display_mm = {{20, 10}},
                                            .portrait = way.portrait,
                                            .mirror_x = way.mirror_x,
                                            .mirror_y = way.mirror_y},
                                           {})
                                   .grid(all);
        EXPECT_NEAR(grid.u0, way.column, 1e-9) << way.portrait << way.mirror_x << way.mirror_y;
        EXPECT_NEAR(grid.v0, way.row, 1e-9) << way.portrait << way.mirror_x << way.mirror_y;
        EXPECT_EQ(grid.uy != 0, way.portrait);
        EXPECT_EQ(grid.vx != 0, way.portrait);
    }
}

TEST(Display, SaysWhyAPartDoesNotFit) {
    expect_refusal("the part measures 30 x 5 mm and the display of the P only 20 x 10 mm (200 x 100 pixels)",
                   box(0, 0, 30, 5), {}, printer());
    expect_refusal("measures 5 x 10.2 mm", box(0, 0, 5, 10.2), {}, printer());
    EXPECT_NO_THROW(static_cast<void>(display_for(box(0, 0, 20.004, 10), {}, printer())));
}

TEST(Display, SaysHowMuchAPartIsTooHigh) {
    ResinPrinter low = printer();
    low.height_mm = 0.75;
    expect_refusal("the part is 1 mm high, and the P makes parts of up to 0.75 mm: it is 0.25 mm too high",
                   box(0, 0, 5, 5), {}, low);
    low.height_mm = 0.9999;
    EXPECT_NO_THROW(static_cast<void>(display_for(box(0, 0, 5, 5), {}, low)));
}

TEST(Display, ShowsNoGreyOnDisplaysWithoutGrey) {
    ResinPrinter plain = printer();
    EXPECT_EQ(raster_for({}, plain).antialias, RasterOptions{}.antialias);
    plain.grey = false;
    EXPECT_EQ(raster_for({.raster = {.antialias = 8, .gamma = 2}}, plain).antialias, 1U);
}

TEST(Display, SaysWhatContradictsItself) {
    const Box3 part = box(0, 0, 5, 5);
    constexpr double nan = std::numeric_limits<double>::quiet_NaN();
    expect_refusal("100 pixels of 0.1 mm are 10 mm, not the 12 mm of the display", part,
                   {.pixel_mm = {{0.1, 0.1}}, .pixels = {{100, 100}}, .display_mm = {{12, 10}}});
    expect_refusal("which is no whole number", part, {.pixel_mm = {{0.1, 0.07}}, .display_mm = {{10, 10}}});
    expect_refusal("a pixel of 0 x 0.1 mm", part, {.pixel_mm = {{0, 0.1}}});
    expect_refusal("a pixel of 1 x nan mm", part, {.pixel_mm = {{1, nan}}});
    expect_refusal("a display of 10 x -1 mm", part, {.display_mm = {{10, -1}}});
    expect_refusal("a resolution with 0 pixels", part, {.pixels = {{10, 0}}});
    expect_refusal("1 to 65535", part, {.pixels = {{65536, 10}}});
    expect_refusal("need 5e+06 pixels of 1e-06 mm, and 65535 are the most", part,
                   {.pixel_mm = {{1e-6, 1e-6}}});
    expect_refusal("65535", part, {.pixel_mm = {{1e-300, 1e-300}}});
}

} // namespace
} // namespace lamella
