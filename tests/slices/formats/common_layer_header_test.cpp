#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/error.hpp"
#include "lamella/inputs/read_file.hpp"

#include "fixtures/expect_error.hpp"
#include "slices/common_layer_files.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace lamella::common_layer_reading {
namespace {

TEST(ReadCommonLayer, ABoxOfTheFirstAndTheLastPlaneReportsNoBottom) {
    const std::string layers =
        "$$LAYER/10\n" + ring.substr(ring.find("$$POLY")) + "$$LAYER/20\n" + ring.substr(ring.find("$$POLY"));
    for (const std::string box : {"0,0,0.1,10,10,0.2", "0,0,0.10000001,10,10,0.2"}) {
        const LayerFile file = read(ascii(layers, "$$UNITS/0.01\n$$DIMENSION/" + box + "\n"));
        const std::vector<LayerPart> parts = file.in_memory();
        EXPECT_TRUE(file.warnings.empty()) << file.warnings.front();
        EXPECT_TRUE(file.guess.empty());
        EXPECT_DOUBLE_EQ(parts.at(0).layers.at(0).bottom, 0);
        EXPECT_DOUBLE_EQ(parts[0].layers[0].top, 0.1);
    }
    const LayerFile bottoms = read(ascii(layers, "$$UNITS/0.01\n$$DIMENSION/0,0,0.1,10,10,0.3\n"));
    const std::vector<LayerPart> bottoms_parts = bottoms.in_memory();
    EXPECT_DOUBLE_EQ(bottoms_parts.at(0).layers.at(0).bottom, 0.1);
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

TEST(ReadCommonLayer, UserDataMayHoldCommands) {
    expect_ring(read(ascii(ring, "$$USERDATA/me,12,$$HEADEREND\n\n$$UNITS/0.01\n")), 96);
    expect_error(ascii(ring, "$$USERDATA/me,99999,x\n$$UNITS/0.01\n"), "user data of 99999 bytes");
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

} // namespace
} // namespace lamella::common_layer_reading
