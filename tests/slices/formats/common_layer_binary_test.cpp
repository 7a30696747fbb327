#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/slices/layer_file.hpp"

#include "fixtures/expect_error.hpp"
#include "slices/common_layer_files.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace lamella::common_layer_reading {
namespace {

TEST(ReadCommonLayer, BinaryLongAndShortFormsAgree) {
    const LayerFile by_long = read(binary(long_ring));
    const std::vector<LayerPart> by_long_parts = by_long.in_memory();
    const LayerFile by_short = read(binary(short_ring));
    const std::vector<LayerPart> by_short_parts = by_short.in_memory();
    expect_ring(by_long, 100);
    expect_ring(by_short, 100);
    EXPECT_EQ(by_long.format, "cli");
    EXPECT_TRUE(same_contours(by_long_parts.at(0).layers.front(), by_short_parts.at(0).layers.front()));
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
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(parts.at(0).layers.size(), 1U);
    EXPECT_EQ(parts[0].layers[0].bottom, -10);
    EXPECT_EQ(parts[0].layers[0].top, -5);
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

} // namespace
} // namespace lamella::common_layer_reading
