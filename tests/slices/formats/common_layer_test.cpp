#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"

#include "fixtures/expect_error.hpp"
#include "slices/common_layer_files.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <filesystem>

namespace lamella::common_layer_reading {
namespace {

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

TEST(ReadCommonLayer, ParametersGoWithWhatLabelsSay) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$LAYER/50\n$$SPEED/900\n$$HATCHES/1,1,1,1,8,8\n",
                                      "$$UNITS/0.01\n$$LABEL/1,\"cube upskin hatch\"\n"));
    ASSERT_EQ(file.parts.size(), 1U);
    EXPECT_EQ(file.parts[0].exposure->region, ScanRegion::upskin);
    EXPECT_EQ(file.parts[0].exposure->parameters.speed_mm_s, 900);
}

TEST(ReadCommonLayer, WithoutAZeroLayerTheFirstLayerIsAsThickAsTheNext) {
    const LayerFile file = read(ascii("$$LAYER/30\n$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n"
                                      "$$LAYER/50\n$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 2U);
    EXPECT_NEAR(parts.at(0).layers[0].bottom, 0.1, 1e-12);
    EXPECT_NEAR(parts.at(0).layers[1].bottom, 0.3, 1e-12);
}

TEST(ReadCommonLayer, ContoursOnTheBottomMakeHeightsBottoms) {
    const LayerFile file = read(ascii("$$LAYER/0\n$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n"
                                      "$$LAYER/20\n$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 2U);
    EXPECT_NEAR(parts.at(0).layers[1].bottom, 0.2, 1e-12);
    EXPECT_NEAR(parts.at(0).layers[1].top, 0.4, 1e-12);
    EXPECT_EQ(file.warnings.size(), 1U);
}

TEST(ReadCommonLayer, WithoutABoxHeightsAreBottomsWhereTheFirstIsZeroOnly) {
    const std::string triangle = "$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n";
    const LayerFile file = read(ascii("$$LAYER/-20\n" + triangle + "$$LAYER/0\n" + triangle));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 2U);
    EXPECT_NEAR(parts.at(0).layers[0].bottom, -0.4, 1e-12);
    EXPECT_EQ(parts.at(0).layers[1].top, 0);
    EXPECT_TRUE(file.warnings.empty());
}

TEST(ReadCommonLayer, TheLayerThatReportsTheBottomHasNoPoints) {
    const std::string triangle = "$$POLYLINE/1,1,4,0,0,10,0,10,10,0,0\n";
    const std::string layers = "$$LAYER/50\n" + triangle + "$$LAYER/100\n" + triangle;
    for (const std::string nothing : {"", "$$HATCHES/1,0\n", "$$POLYLINE/1,1,0\n"}) {
        const LayerStack stack = read(ascii("$$LAYER/0\n" + nothing + layers)).in_memory().at(0).layers;
        ASSERT_EQ(stack.size(), 2U) << nothing;
        EXPECT_EQ(stack[0].bottom, 0);
        EXPECT_EQ(stack[0].top, 0.5);
    }
    // A tip: contours that shrank to a point are dropped, their layer is not.
    const LayerStack tip =
        read(ascii("$$LAYER/25\n$$POLYLINE/1,1,2,0,0,0,0\n" + layers)).in_memory().at(0).layers;
    ASSERT_EQ(tip.size(), 3U);
    EXPECT_EQ(tip[0].bottom, 0);
}

TEST(ReadCommonLayer, ASingleLayerBelowTheBottomOfThePartHasNoThickness) {
    const LayerFile file = read(ascii("$$LAYER/-10\n$$POLYLINE/1,1,4,0,0,9,0,9,9,0,0\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 1U);
    EXPECT_DOUBLE_EQ(parts.at(0).layers[0].z, -0.1);
    EXPECT_EQ(parts.at(0).layers[0].bottom, parts.at(0).layers[0].top);
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
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 2U);
    EXPECT_EQ(parts.at(0).layers[1].rings, 2U);
    EXPECT_EQ(file.warnings.size(), 2U);
}

TEST(ReadCommonLayer, HatchesAreKept) {
    const LayerFile text = read(ascii(ring + "$$HATCHES/1,2,0,0,1,1,2,2,3,3\n"));
    const std::vector<LayerPart> text_parts = text.in_memory();
    expect_ring(text, 96);
    EXPECT_TRUE(text.warnings.empty());
    const std::span<const Point2> lines = text_parts.front().hatches_of(0);
    ASSERT_EQ(lines.size(), 4U);
    EXPECT_EQ(lines[3], (Point2{0.03, 0.03}));
    const LayerFile bytes = read(binary(short_ring + u16(131, 1, 1, 1, 2, 3, 4) + u16(132) + bits(1) +
                                        bits(1) + bits(1.0F) + bits(2.0F) + bits(3.0F) + bits(4.0F)));
    const std::vector<LayerPart> bytes_parts = bytes.in_memory();
    expect_ring(bytes, 100);
    EXPECT_TRUE(bytes.warnings.empty());
    EXPECT_EQ(bytes_parts.front().hatches_of(0).size(), 4U);
}

TEST(ReadCommonLayer, PartsAreReportedByTheirNumbers) {
    const std::string triangle = ",1,4,0,0,10,0,10,10,0,0\n";
    const LayerFile file =
        read(ascii("$$LAYER/0\n$$LAYER/50\n$$POLYLINE/7" + triangle + "$$POLYLINE/3" + triangle +
                       "$$POLYLINE/7" + triangle + "$$LAYER/90\n$$HATCHES/7,1,0,0,1,1\n",
                   "$$UNITS/0.01\n$$LABEL/7,seven\n$$LABEL/9,\"nine\"\n"));
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(file.parts.size(), 3U);
    EXPECT_EQ(file.parts[0].label, "");
    EXPECT_EQ(file.parts[1].label, "seven");
    EXPECT_EQ(file.parts[2].label, "nine");
    EXPECT_EQ(parts[0].layers[0].rings, 1U);
    EXPECT_EQ(parts[1].layers[0].rings, 2U);
    EXPECT_EQ(parts[2].layers[0].rings, 0U);
    EXPECT_EQ(parts[1].hatches_of(1).size(), 2U);
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

TEST(ReadCommonLayer, PublishedSamplesHaveTheirArea) {
    const std::filesystem::path folder =
        std::filesystem::path(LAMELLA_SHARED) / "formats" / "samples" / "own";
    if (!std::filesystem::exists(folder))
        GTEST_SKIP() << "no samples at " << folder;
    for (const char* name : {"ring_ascii.cli", "ring_long.cli", "ring_short.cli", "ring_short_align.cli"}) {
        const LayerFile file = read_layers((folder / name).string());
        const std::vector<LayerPart> parts = file.in_memory();
        ASSERT_EQ(parts.at(0).layers.size(), 2U) << name;
        for (const Layer& layer : parts.at(0).layers)
            EXPECT_NEAR(measure(layer).area_mm2, 96, 1e-9) << name;
    }
}

} // namespace
} // namespace lamella::common_layer_reading
