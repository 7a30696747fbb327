#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/slices/layer_file.hpp"

#include "fixtures/expect_error.hpp"
#include "slices/common_layer_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>

namespace lamella::common_layer_reading {
namespace {

TEST(ReadCommonLayer, AsciiReportsHeightsAndContours) {
    const LayerFile file = read(ascii(ring));
    const std::vector<LayerPart> parts = file.in_memory();
    expect_ring(file, 96);
    EXPECT_EQ(file.format, "cli-ascii");
    EXPECT_EQ(parts.at(0).layers.front().rings, 2U);
    EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
}

TEST(ReadCommonLayer, IntegersLeadingZerosCommentsAndUnknownCommandsAreFine) {
    const LayerFile file = read(
        "// made by hand //\n$$HEADERSTART\r\n$$ASCII // text //\r\n$$UNITS/00000000.010000\r\n"
        "$$DATE/20240702\r\n$$LABEL/1,\"a part\"\r\n$$LAYERS/000002\r\n$$HEADEREND\r\n$$GEOMETRYSTART\r\n"
        "$$LAYER/0\r\n$$LAYER/50 // top //\r\n$$POWER/100.0\r\n$$POLYLINE/1,1,5,0,0,1000,0,\r\n"
        "1000,1000,0,+1000,.0,0.\r\n$$GEOMETRYEND\r\nanything");
    expect_ring(file, 100);
    EXPECT_EQ(file.parts.at(0).exposure.value().part, "a part");
    EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
}

TEST(ReadCommonLayer, CommandsMayFollowUnknownOnesOnTheirLine) {
    std::string line = ascii(ring, "$$UNITS/0.01 $$VERSION/200 $$DATE/010101 ignored\n");
    std::replace(line.begin(), line.end(), '\n', ' ');
    expect_ring(read(line), 96);
    const std::string power =
        "$$POWER/100.0 // $$LAYER/90 // $$POLYLINE/1,1,5,0,0,1000,0,1000,1000,0,1000,0,0\n";
    expect_ring(read(ascii("$$LAYER/0\n$$LAYER/50\n" + power)), 100);
}

TEST(ReadCommonLayer, PowerSpeedAndFocusAreParametersOfTheVectorsThatFollow) {
    const std::string square = "$$POLYLINE/1,1,5,0,0,9,0,9,9,0,9,0,0\n";
    const LayerFile file = read(ascii(
        "$$LAYER/0\n$$LAYER/50\n" + square + "$$POWER/100.0\n$$SPEED/800\n$$FOCUS/-1.5 // mm //\n" + square +
            "$$HATCHES/1,1,1,1,8,8\n$$LAYER/90\n$$HATCHES/1,1,2,2,8,8\n$$POWER/150\n$$HATCHES/1,1,3,3,8,8\n",
        "$$UNITS/0.01\n$$LABEL/1,cube\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
    ASSERT_EQ(file.parts.size(), 4U);
    EXPECT_FALSE(file.parts[0].exposure);
    EXPECT_EQ(file.parts[0].label, "cube");
    EXPECT_EQ(parts[0].layers[0].rings, 1U);
    for (std::size_t i = 1; i < 4; ++i) {
        const Exposure& exposure = file.parts[i].exposure.value();
        EXPECT_EQ(exposure.part, "cube");
        EXPECT_EQ(file.parts[i].label, exposure.label());
        EXPECT_EQ(exposure.parameters.power_w, i < 3 ? 100 : 150);
        EXPECT_EQ(exposure.parameters.speed_mm_s, 800);
        EXPECT_EQ(exposure.parameters.focus_mm, -1.5);
        EXPECT_EQ(exposure.kind, i == 1 ? VectorKind::contour : VectorKind::hatch);
        EXPECT_EQ(exposure.contour, i == 1 ? 1U : 0U);
    }
    EXPECT_EQ(parts[1].layers[0].rings, 1U);
    EXPECT_EQ(parts[2].hatches_of(0).size(), 2U);
    EXPECT_EQ(parts[2].hatches_of(1).size(), 2U);
    EXPECT_EQ(parts[3].hatches_of(1).size(), 2U);
}

TEST(ReadCommonLayer, CommandsThatNobodyKnowsAreCounted) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$LAYER/50\n$$DELAY/7\n$$POWER/much\n$$SPEED/"
                                      "-5\n$$POLYLINE/1,1,5,0,0,9,0,9,9,0,9,0,0\n"));
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_TRUE(file.warnings[0].starts_with("3 commands are unknown here")) << file.warnings[0];
    EXPECT_NE(file.warnings[0].find("line 9, $$DELAY"), std::string::npos) << file.warnings[0];
    EXPECT_FALSE(file.parts.at(0).exposure);
}

TEST(ReadCommonLayer, OpenContoursThatEndWhereTheyBeganAreClosed) {
    const LayerFile file =
        read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,2,5,0,0,1000,0,1000,1000,0,1000,0,0\n"
                   "$$POLYLINE/1,2,3,0,0,5,5,0,0\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    const Layer& layer = parts.at(0).layers.at(0);
    EXPECT_EQ(layer.rings, 1U);
    EXPECT_EQ(layer.open_chains(), 1U); // which bounds nothing, forth and back
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_TRUE(file.warnings[0].starts_with("1 open contour ends where it began")) << file.warnings[0];
}

TEST(ReadCommonLayer, ErrorsNameTheLineOnWhichSomethingIsMissing) {
    expect_error(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,1,5,0,0,1,0,1,1\n\n\n$$LAYER/90\n"),
                 "line 9: found the end of the line; ',' must stand before the next coordinate");
    expect_error(ascii("$$LAYER/0\n$$LAYER/\n$$LAYER/90\n"),
                 "line 8: found the end of the line; the layer's height");
    expect_error(ascii(ring, "$$VERSION/200\n$$UNITS/\n$$DATE/1\n"),
                 "line 4: found the end of the line; the units");
    // Numbers may go on over lines: what is wrong with one stands on its own line.
    expect_error(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,1,5,0,0,\n1,x,1,1\n"), "line 10: found 'x'");
}

TEST(ReadCommonLayer, NumbersHaveOneSign) {
    expect_error(ascii("$$LAYER/+-1.0\n"), "line 7: found '+-1.0'; the layer's height must be a number");
}

TEST(ReadCommonLayer, PlacesInTextsAreLines) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$LAYER/50\n$$LAYER/20\n"));
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_NE(file.warnings[0].find("z = 0.2 mm follows z = 0.5 mm (line 9)"), std::string::npos)
        << file.warnings[0];
    expect_error(ascii("$$LAYER/0\n$$LAYER/1e200\n"), "layer at line 8");
}

TEST(ReadCommonLayer, StatedDirectionHoldsAgainstTheOrderOfPoints) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,0,4,0,0,10,0,10,10,0,0\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_LT(measure(parts.at(0).layers.front()).area_mm2, 0);
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_NE(file.warnings.front().find("reversed"), std::string::npos);
}

TEST(ReadCommonLayer, UnclosedRingsAreClosedAndSlightOnesDropped) {
    const LayerFile file =
        read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,1,3,0,0,10,0,10,10\n$$POLYLINE/1,1,3,0,0,1,1,0,0\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_EQ(parts.at(0).layers.front().rings, 1U);
    EXPECT_EQ(file.warnings.size(), 2U);
}

TEST(ReadCommonLayer, OpenLinesStayOpen) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,2,3,0,0,10,0,10,10\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    EXPECT_EQ(parts.at(0).layers.front().open_chains(), 1U);
}

} // namespace
} // namespace lamella::common_layer_reading
