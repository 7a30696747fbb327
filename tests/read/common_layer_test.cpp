#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/read/layer_file.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <memory>
#include <random>

namespace lamella {

namespace {

LayerFile read(const std::string& bytes) {
    // Exactly as long as the bytes, so that a sanitizer sees one byte too far.
    const auto copy = std::make_unique<std::byte[]>(bytes.size());
    std::memcpy(copy.get(), bytes.data(), bytes.size());
    return read_layers(std::span(copy.get(), bytes.size()), "test.cli");
}

std::string error_of(const std::string& bytes) {
    return test::error_of(ErrorKind::input, [&] { static_cast<void>(read(bytes)); });
}

void expect_error(const std::string& bytes, const std::string& part) {
    EXPECT_NE(error_of(bytes).find(part), std::string::npos) << error_of(bytes);
}

std::string ascii(const std::string& geometry, const std::string& header = "$$UNITS/0.01\n$$VERSION/200\n") {
    return "$$HEADERSTART\n$$ASCII\n" + header + "$$HEADEREND\n$$GEOMETRYSTART\n" + geometry +
           "$$GEOMETRYEND\n";
}

// A square of 10 mm with a hole of 2 mm, in units of 0.01 mm, from z = 0 to 0.5 mm.
const std::string ring = "$$LAYER/0.0\n$$LAYER/50.0\n"
                         "$$POLYLINE/1,1,5,0.0,0.0,1000.0,0.0,1000.0,1000.0,0.0,1000.0,0.0,0.0\n"
                         "$$POLYLINE/1,0,5,200.0,200.0,200.0,400.0,400.0,400.0,400.0,200.0,200.0,200.0\n";

template <class T>
std::string bits(T value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

template <class... T>
std::string u16(T... values) {
    return (bits(static_cast<std::uint16_t>(values)) + ...);
}

std::string binary(const std::string& geometry, const std::string& header = "$$UNITS/0.01\n") {
    return "$$HEADERSTART\n$$BINARY\n" + header + "$$HEADEREND" + geometry;
}

std::string long_square(float to) {
    std::string bytes = u16(130) + bits(1) + bits(1) + bits(5);
    for (const float v : {0.0F, 0.0F, to, 0.0F, to, to, 0.0F, to, 0.0F, 0.0F})
        bytes += bits(v);
    return bytes;
}

const std::string long_ring = u16(127) + bits(0.0F) + u16(127) + bits(50.0F) + long_square(1000);
const std::string short_ring = u16(128, 0, 128, 50, 129, 1, 1, 5, 0, 0, 1000, 0, 1000, 1000, 0, 1000, 0, 0);

void expect_ring(const LayerFile& file, double area) {
    ASSERT_EQ(file.parts.at(0).layers.size(), 1U);
    const Layer& layer = file.parts.at(0).layers.front();
    EXPECT_DOUBLE_EQ(measure(layer).area_mm2, area);
    EXPECT_DOUBLE_EQ(layer.bottom, 0);
    EXPECT_DOUBLE_EQ(layer.z, 0.25);
    EXPECT_DOUBLE_EQ(layer.top, 0.5);
    EXPECT_TRUE(in_normal_form(layer));
}

} // namespace

TEST(ReadCommonLayer, AsciiReportsHeightsAndContours) {
    const LayerFile file = read(ascii(ring));
    expect_ring(file, 96);
    EXPECT_EQ(file.format, "cli-ascii");
    EXPECT_EQ(file.parts.at(0).layers.front().rings, 2U);
    EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
}

TEST(ReadCommonLayer, BinaryLongAndShortFormsAgree) {
    const LayerFile by_long = read(binary(long_ring));
    const LayerFile by_short = read(binary(short_ring));
    expect_ring(by_long, 100);
    expect_ring(by_short, 100);
    EXPECT_EQ(by_long.format, "cli");
    EXPECT_TRUE(same_contours(by_long.parts.at(0).layers.front(), by_short.parts.at(0).layers.front()));
}

TEST(ReadCommonLayer, RoundingIsThatOfTheCoordinatesAndNotAlwaysAUnit) {
    const auto step_of_ascii = [](const std::string& x) {
        return read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,1,4,0,0," + x + ",0,0,9,0,0\n"))
            .rounding.step_mm;
    };
    EXPECT_EQ(step_of_ascii("1000"), 0.01);
    EXPECT_EQ(step_of_ascii("-1000.0"), 0.01);
    EXPECT_DOUBLE_EQ(step_of_ascii("1000.5"), 0.001);
    EXPECT_DOUBLE_EQ(step_of_ascii("12345.678"), 1e-5);
    EXPECT_EQ(step_of_ascii("0.12345678"), 0);

    const Rounding whole{.step_mm = 0.01, .single_precision = true};
    EXPECT_EQ(read(binary(long_ring)).rounding, whole);
    EXPECT_EQ(read(binary(short_ring)).rounding, whole);
    const std::string bottom = u16(127) + bits(0.0F) + u16(127) + bits(50.0F);
    for (const float to : {1000.5F, 1000.0001F})
        EXPECT_EQ(read(binary(bottom + long_square(to))).rounding, Rounding{.single_precision = true});
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
    EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
    ASSERT_EQ(file.parts.size(), 4U);
    EXPECT_FALSE(file.parts[0].exposure);
    EXPECT_EQ(file.parts[0].label, "cube");
    EXPECT_EQ(file.parts[0].layers[0].rings, 1U);
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
    EXPECT_EQ(file.parts[1].layers[0].rings, 1U);
    EXPECT_EQ(file.parts[2].layers[0].hatches.size(), 2U);
    EXPECT_EQ(file.parts[2].layers[1].hatches.size(), 2U);
    EXPECT_EQ(file.parts[3].layers[1].hatches.size(), 2U);
}

TEST(ReadCommonLayer, ParametersGoWithWhatLabelsSay) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$LAYER/50\n$$SPEED/900\n$$HATCHES/1,1,1,1,8,8\n",
                                      "$$UNITS/0.01\n$$LABEL/1,\"cube upskin hatch\"\n"));
    ASSERT_EQ(file.parts.size(), 1U);
    EXPECT_EQ(file.parts[0].exposure->region, ScanRegion::upskin);
    EXPECT_EQ(file.parts[0].exposure->parameters.speed_mm_s, 900);
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
    const Layer& layer = file.parts.at(0).layers.at(0);
    EXPECT_EQ(layer.rings, 1U);
    EXPECT_EQ(layer.open_chains(), 1U); // which bounds nothing, forth and back
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_TRUE(file.warnings[0].starts_with("1 open contour ends where it began")) << file.warnings[0];
}

TEST(ReadCommonLayer, ABoxOfTheFirstAndTheLastPlaneReportsNoBottom) {
    const std::string layers =
        "$$LAYER/10\n" + ring.substr(ring.find("$$POLY")) + "$$LAYER/20\n" + ring.substr(ring.find("$$POLY"));
    for (const std::string box : {"0,0,0.1,10,10,0.2", "0,0,0.10000001,10,10,0.2"}) {
        const LayerFile file = read(ascii(layers, "$$UNITS/0.01\n$$DIMENSION/" + box + "\n"));
        EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
        EXPECT_TRUE(file.guess.empty());
        EXPECT_DOUBLE_EQ(file.parts.at(0).layers.at(0).bottom, 0);
        EXPECT_DOUBLE_EQ(file.parts[0].layers[0].top, 0.1);
    }
    const LayerFile bottoms = read(ascii(layers, "$$UNITS/0.01\n$$DIMENSION/0,0,0.1,10,10,0.3\n"));
    EXPECT_DOUBLE_EQ(bottoms.parts.at(0).layers.at(0).bottom, 0.1);
    ASSERT_EQ(bottoms.warnings.size(), 1U);
    EXPECT_EQ(bottoms.guess, bottoms.warnings[0]);
}

TEST(ReadCommonLayer, ABoxWithoutSixNumbersIsLeftOut) {
    for (const std::string box :
         {"$$DIMENSION/0,0,0,10\n", "$$DIMENSION\n", "$$DIMENSION/0,0,low,10,10,1\n"}) {
        const LayerFile file = read(ascii(ring, box + "$$UNITS/0.01\n"));
        expect_ring(file, 96);
        ASSERT_EQ(file.warnings.size(), 1U) << box;
        EXPECT_TRUE(file.warnings[0].starts_with("$$DIMENSION (line 3) has")) << file.warnings[0];
    }
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

TEST(ReadCommonLayer, LabelsAreTextAndNoLongerThanOneIsMeantToBe) {
    const LayerFile odd = read(ascii(ring, "$$UNITS/0.01\n$$LABEL/1,\"b\xe4r\x1b[31m\x7f\"\n"));
    EXPECT_EQ(odd.parts.at(0).label, "b\\xe4r\\x1b[31m\\x7f");
    ASSERT_EQ(odd.warnings.size(), 1U);
    EXPECT_TRUE(odd.warnings[0].starts_with("1 label has bytes")) << odd.warnings[0];
    const LayerFile longer = read(ascii(ring, "$$UNITS/0.01\n$$LABEL/1," + std::string(100'000, 'x') + "\n"));
    EXPECT_LT(longer.parts.at(0).label.size(), 5000U);
    EXPECT_LT(longer.warnings.at(0).size(), 500U);
}

TEST(ReadCommonLayer, LabelsCountAgainstTheLimitOfMemory) {
    const std::string bytes = ascii(ring, "$$UNITS/0.01\n$$LABEL/1," + std::string(100'000, 'x') + "\n");
    const std::string error = test::error_of(ErrorKind::limit, [&] {
        static_cast<void>(
            read_layers(std::as_bytes(std::span(bytes)), "test.cli", {.max_memory = bytes.size() + 1000}));
    });
    EXPECT_NE(error.find("line 4"), std::string::npos) << error;
}

TEST(ReadCommonLayer, LabelsEndWhereACommentBegins) {
    for (const std::string label : {"a part // 1 //", "\"a part\" // 1 //", "a part"})
        EXPECT_EQ(read(ascii(ring, "$$UNITS/0.01\n$$LABEL/1," + label + "\n")).parts.at(0).label, "a part");
    EXPECT_EQ(read(ascii(ring, "$$UNITS/0.01\n$$LABEL/1,http://a\n")).parts.at(0).label, "http://a");
}

TEST(ReadCommonLayer, CommandsMayFollowALabelOnItsLine) {
    for (const std::string label : {"a part", "\"a part\"", "\"a part\" // 1 //"}) {
        const LayerFile file = read(ascii(ring, "$$LABEL/1," + label + " $$UNITS/0.01 $$LABEL/2,other\n"));
        expect_ring(file, 96);
        EXPECT_EQ(file.parts.at(0).label, "a part");
        EXPECT_EQ(file.parts.at(1).label, "other");
    }
    EXPECT_EQ(read(ascii(ring, "$$LABEL/1,\"5 $$ // a //\"\n$$UNITS/0.01\n")).parts.at(0).label,
              "5 $$ // a //");
    EXPECT_EQ(read(ascii(ring, "$$LABEL/1,\"half\n$$UNITS/0.01\n")).parts.at(0).label, "\"half");
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

TEST(ReadCommonLayer, UserDataMayHoldCommands) {
    expect_ring(read(ascii(ring, "$$USERDATA/me,12,$$HEADEREND\n\n$$UNITS/0.01\n")), 96);
    expect_error(ascii(ring, "$$USERDATA/me,99999,x\n$$UNITS/0.01\n"), "user data of 99999 bytes");
}

TEST(ReadCommonLayer, StatedDirectionHoldsAgainstTheOrderOfPoints) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,0,4,0,0,10,0,10,10,0,0\n"));
    EXPECT_LT(measure(file.parts.at(0).layers.front()).area_mm2, 0);
    ASSERT_EQ(file.warnings.size(), 1U);
    EXPECT_NE(file.warnings.front().find("reversed"), std::string::npos);
}

TEST(ReadCommonLayer, UnclosedRingsAreClosedAndSlightOnesDropped) {
    const LayerFile file =
        read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,1,3,0,0,10,0,10,10\n$$POLYLINE/1,1,3,0,0,1,1,0,0\n"));
    EXPECT_EQ(file.parts.at(0).layers.front().rings, 1U);
    EXPECT_EQ(file.warnings.size(), 2U);
}

TEST(ReadCommonLayer, OpenLinesStayOpen) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/1,2,3,0,0,10,0,10,10\n"));
    EXPECT_EQ(file.parts.at(0).layers.front().open_chains(), 1U);
}

TEST(ReadCommonLayer, WithoutAZeroLayerTheFirstLayerIsAsThickAsTheNext) {
    const LayerFile file = read(ascii("$$LAYER/30\n$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n"
                                      "$$LAYER/50\n$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n"));
    ASSERT_EQ(file.parts.at(0).layers.size(), 2U);
    EXPECT_NEAR(file.parts.at(0).layers[0].bottom, 0.1, 1e-12);
    EXPECT_NEAR(file.parts.at(0).layers[1].bottom, 0.3, 1e-12);
}

TEST(ReadCommonLayer, ContoursOnTheBottomMakeHeightsBottoms) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n"
                                      "$$LAYER/20\n$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n"));
    ASSERT_EQ(file.parts.at(0).layers.size(), 2U);
    EXPECT_NEAR(file.parts.at(0).layers[1].bottom, 0.2, 1e-12);
    EXPECT_NEAR(file.parts.at(0).layers[1].top, 0.4, 1e-12);
    EXPECT_EQ(file.warnings.size(), 1U);
}

TEST(ReadCommonLayer, WithoutABoxHeightsAreBottomsWhereTheFirstIsZeroOnly) {
    const std::string triangle = "$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n";
    const LayerFile file = read(ascii("$$LAYER/-20\n" + triangle + "$$LAYER/0\n" + triangle));
    ASSERT_EQ(file.parts.at(0).layers.size(), 2U);
    EXPECT_NEAR(file.parts.at(0).layers[0].bottom, -0.4, 1e-12);
    EXPECT_EQ(file.parts.at(0).layers[1].top, 0);
    EXPECT_TRUE(file.warnings.empty());
}

TEST(ReadCommonLayer, TheLayerThatReportsTheBottomHasNoPoints) {
    const std::string triangle = "$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n";
    const std::string layers = "$$LAYER/50\n" + triangle + "$$LAYER/100\n" + triangle;
    for (const std::string nothing : {"", "$$HATCHES/1,0\n", "$$POLYLINE/1,1,0\n"}) {
        const LayerStack stack = read(ascii("$$LAYER/0\n" + nothing + layers)).parts.at(0).layers;
        ASSERT_EQ(stack.size(), 2U) << nothing;
        EXPECT_EQ(stack[0].bottom, 0);
        EXPECT_EQ(stack[0].top, 0.5);
    }
    // A tip: contours that shrank to a point are dropped, their layer is not.
    const LayerStack tip = read(ascii("$$LAYER/25\n$$POLYLINE/1,1,2,0,0,0,0\n" + layers)).parts.at(0).layers;
    ASSERT_EQ(tip.size(), 3U);
    EXPECT_EQ(tip[0].bottom, 0);
}

TEST(ReadCommonLayer, ASingleLayerBelowTheBottomOfThePartHasNoThickness) {
    const LayerFile file = read(ascii("$$LAYER/-10\n$$POLYLINE/1,1,4,0,0,9,0,9,9,0,0\n"));
    ASSERT_EQ(file.parts.at(0).layers.size(), 1U);
    EXPECT_DOUBLE_EQ(file.parts.at(0).layers[0].z, -0.1);
    EXPECT_EQ(file.parts.at(0).layers[0].bottom, file.parts.at(0).layers[0].top);
}

TEST(ReadCommonLayer, NumbersThatOverflowInMillimetresAreRefused) {
    const std::string units = "$$UNITS/1e200\n";
    expect_error(ascii("$$LAYER/1e200\n", units), "1e+200 units of 1e+200 mm");
    expect_error(ascii("$$LAYER/-1e200\n", units), "must lie within");
    expect_error(ascii("$$LAYER/0\n$$POLYLINE/1,1,4,0,0,1,0,1,1e50,0,0\n", "$$UNITS/1e60\n"),
                 "1e+50 units of 1e+60 mm");
    expect_error(binary(u16(127) + bits(3e38F), "$$UNITS/1e300\n"), "must lie within");
}

TEST(ReadCommonLayer, LayersOutOfOrderAreSortedAndEqualOnesJoined) {
    const std::string triangle = "$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n";
    const LayerFile file = read(
        ascii("$$LAYER/0\n$$LAYER/50\n" + triangle + "$$LAYER/20\n" + triangle + "$$LAYER/50\n" + triangle));
    ASSERT_EQ(file.parts.at(0).layers.size(), 2U);
    EXPECT_EQ(file.parts.at(0).layers[1].rings, 2U);
    EXPECT_EQ(file.warnings.size(), 2U);
}

TEST(ReadCommonLayer, HatchesAreKept) {
    const LayerFile text = read(ascii(ring + "$$HATCHES/1,2,0,0,1,1,2,2,3,3\n"));
    expect_ring(text, 96);
    EXPECT_TRUE(text.warnings.empty());
    const PointArray& lines = text.parts.front().layers.front().hatches;
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[3], (Point2{0.03, 0.03}));
    const LayerFile bytes = read(binary(short_ring + u16(131, 1, 1, 1, 2, 3, 4) + u16(132) + bits(1) +
                                        bits(1) + bits(1.0F) + bits(2.0F) + bits(3.0F) + bits(4.0F)));
    expect_ring(bytes, 100);
    EXPECT_TRUE(bytes.warnings.empty());
    EXPECT_EQ(bytes.parts.front().layers.front().hatches.size(), 4U);
}

TEST(ReadCommonLayer, PartsAreReportedByTheirNumbers) {
    const std::string triangle = ",1,4,0,0,10,0,10,10,0,0\n";
    const LayerFile file =
        read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/7" + triangle + "$$POLYLINE/3" + triangle +
                       "$$POLYLINE/7" + triangle + "$$LAYER/90\n$$HATCHES/7,1,0,0,1,1\n",
                   "$$UNITS/0.01\n$$LABEL/7,seven\n$$LABEL/9,\"nine\"\n"));
    ASSERT_EQ(file.parts.size(), 3U);
    EXPECT_EQ(file.parts[0].label, "");
    EXPECT_EQ(file.parts[1].label, "seven");
    EXPECT_EQ(file.parts[2].label, "nine");
    EXPECT_EQ(file.parts[0].layers[0].rings, 1U);
    EXPECT_EQ(file.parts[1].layers[0].rings, 2U);
    EXPECT_EQ(file.parts[2].layers[0].rings, 0U);
    EXPECT_EQ(file.parts[1].layers[1].hatches.size(), 2U);
    EXPECT_EQ(file.merged()[0].rings, 3U);
}

TEST(ReadCommonLayer, MorePartsThanCanBeMeantAreRefused) {
    std::string geometry;
    for (int i = 0; i < 3000; ++i)
        geometry += u16(128, i);
    for (int i = 0; i < 3000; ++i)
        geometry += u16(129, i, 1, 0);
    expect_error(binary(geometry), "3000 parts on");
}

TEST(ReadCommonLayer, ShortNumbersAreSignedWhereTheBoxIsNegative) {
    const std::string geometry = u16(128, 0, 128, 50, 129, 1, 1, 5, 65036, 65036, 500, 65036, 500, 500, 65036,
                                     500, 65036, 65036); // 65036 is -500
    expect_ring(read(binary(geometry, "$$UNITS/0.01\n$$DIMENSION/-5,-5,0,5,5,0.5\n")), 100);
}

TEST(ReadCommonLayer, ShortHeightsAreSignedWhereTheBoxReachesBelowZero) {
    const std::string geometry =
        u16(128, 65526, 128, 65536 - 5, 129, 1, 1, 5, 0, 0, 10, 0, 10, 10, 0, 10, 0, 0);
    const LayerFile file = read(binary(geometry, "$$UNITS/1\n$$DIMENSION/0,0,-10,10,10,0\n"));
    ASSERT_EQ(file.parts.at(0).layers.size(), 1U);
    EXPECT_EQ(file.parts[0].layers[0].bottom, -10);
    EXPECT_EQ(file.parts[0].layers[0].top, -5);
    EXPECT_TRUE(file.warnings.empty());
}

TEST(ReadCommonLayer, AlignedGeometryStartsOnAWordAndPadsShortNumbers) {
    std::string header = "$$HEADERSTART\n$$BINARY\n$$UNITS/0.01\n$$ALIGN\n";
    while ((header.size() + 12) % 4 != 0)
        header += ' ';
    header += "$$HEADEREND";
    while (header.size() % 4 != 0)
        header += '\n';
    const std::string square = u16(0, 0, 1000, 0, 1000, 1000, 0, 1000, 0, 0);
    expect_ring(read(header + u16(128, 0, 0, 0, 128, 0, 50, 0, 129, 0, 1, 0, 1, 0, 5, 0) + square), 100);
}

TEST(ReadCommonLayer, ALineEndBehindTheHeaderOrPaddingAtTheEndDoesNoHarm) {
    expect_ring(read(binary("\n" + long_ring)), 100);
    expect_ring(read(binary("\r\n" + long_ring + "\r\n")), 100);
    expect_ring(read(binary(long_ring + std::string(3, '\0'))), 100);
}

TEST(ReadCommonLayer, HeadersThatSayTooLittleOrTooMuchAreRefused) {
    expect_error("$$HEADERSTART\n$$ASCII\n$$UNITS/1\n", "$$HEADEREND");
    expect_error(ascii(ring, ""), "no $$UNITS");
    expect_error(ascii(ring, "$$UNITS/0\n"), "above 0");
    expect_error(ascii(ring, "$$UNITS/-1\n"), "above 0");
    expect_error(ascii(ring, "$$UNITS/nan\n"), "must be a number");
    expect_error(ascii(ring, "$$UNITS/1,5\n"), "found '1,5'; the units must be a number");
    expect_error(ascii(ring, "$$UNITS/1.5abc\n"), "found '1.5abc'; the units must be a number");
    expect_error(ascii(ring, "$$UNITS/1\n$$BINARY\n"), "both");
    expect_error("$$HEADERSTART\n$$UNITS/1\n$$HEADEREND", "neither");
    expect_error(ascii("", "$$UNITS/1\n"), "no layer");
    expect_error(ascii(ring, "$$UNITS/1 // unfinished\n"), "comment");
}

TEST(ReadCommonLayer, BrokenGeometryIsRefusedWithItsPlace) {
    expect_error(ascii("$$POLYLINE/1,1,3,0,0,1,0,1,1\n"), "before the first $$LAYER");
    expect_error(ascii("$$LAYER/1\n$$POLYLINE/1,3,3,0,0,1,0,1,1\n"), "line 8: found direction 3");
    expect_error(ascii("$$LAYER/1\n$$POLYLINE/1,1,4,0,0,1,0,1,1\n"), "','");
    expect_error(ascii("$$LAYER/1\n$$POLYLINE/1,1,2,0,0,1,0,1,1\n"), "count of 2");
    expect_error(ascii("$$LAYER/1\n$$POLYLINE/1,1,4000000000,0,0,1,0,1,1\n"), "count of 4000000000");
    expect_error(ascii("$$LAYER/1\n$$POLYLINE/1,1,-1,0,0,1,0,1,1\n"), "count of -1");
    expect_error(ascii("$$LAYER/1\n$$POLYLINE/1,1,3,0,0,1e999,0,1,1\n"), "must be a number");
    expect_error(ascii("$$LAYER/1\n").substr(0, 80), "$$GEOMETRYEND");
    expect_error(binary(long_square(1)), "before the first layer");
    expect_error(binary(u16(127) + bits(0.0F) + u16(140)), "command 140");
    expect_error(binary(u16(127) + bits(0.0F) + u16(130) + bits(1) + bits(1) + bits(-1)), "count of -1");
    expect_error(binary(u16(127) + bits(0.0F) + u16(130) + bits(1) + bits(1) + bits(0x7FFFFFFF)),
                 "count of 2147483647");
    expect_error(binary(u16(127) + bits(std::numeric_limits<float>::quiet_NaN())), "not finite");
}

TEST(ReadCommonLayer, EveryTruncatedFileIsAnErrorOrFewerContours) {
    for (const std::string& whole : {ascii(ring), binary(long_ring), binary(short_ring)}) {
        for (std::size_t n = 1; n < whole.size(); ++n) {
            try {
                EXPECT_LE(read(whole.substr(0, n)).parts.at(0).layers.size(), 2U);
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            }
        }
    }
}

TEST(ReadCommonLayer, MutatedFilesNeverCrash) {
    std::mt19937 random(7);
    for (const std::string& whole : {ascii(ring), binary(long_ring), binary(short_ring)}) {
        for (int round = 0; round < 1500; ++round) {
            std::string bytes = whole;
            for (int change = 0; change < 3; ++change)
                bytes[random() % bytes.size()] = static_cast<char>(random());
            try {
                static_cast<void>(read(bytes));
            } catch (const Error& error) {
                EXPECT_EQ(error.kind(), ErrorKind::input) << error.what();
            }
        }
    }
}

TEST(ReadCommonLayer, PublishedSamplesHaveTheirArea) {
    const std::filesystem::path folder =
        std::filesystem::path(LAMELLA_SHARED) / "formats" / "samples" / "own";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no samples at " << folder;
    for (const char* name : {"ring_ascii.cli", "ring_long.cli", "ring_short.cli", "ring_short_align.cli"}) {
        const LayerFile file = read_layers((folder / name).string());
        ASSERT_EQ(file.parts.at(0).layers.size(), 2U) << name;
        for (const Layer& layer : file.parts.at(0).layers)
            EXPECT_NEAR(measure(layer).area_mm2, 96, 1e-9) << name;
    }
}

} // namespace lamella
