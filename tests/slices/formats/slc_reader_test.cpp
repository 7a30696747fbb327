#include "lamella/contour/measure.hpp"
#include "lamella/inputs/read_file.hpp"

#include "fixtures/expect_error.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <initializer_list>

namespace lamella::slc_cases {
namespace {

template <class T>
std::string bits(T value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    return bytes;
}

LayerFile read(const std::string& bytes) {
    return read_layers(std::as_bytes(std::span(bytes)), "test.slc");
}

std::string error_of(const std::string& bytes) {
    return test::error_of(ErrorKind::input, [&] { static_cast<void>(read(bytes)); });
}

std::string header(const std::string& keywords = "-SLCVER 2.0 -UNIT MM -TYPE PART ",
                   const std::string& end = "\r\n\x1a") {
    return keywords + end + std::string(256, ' ') + '\1' + bits(0.0F) + bits(0.5F) + bits(0.0F) + bits(0.0F);
}

std::string contour(std::initializer_list<float> numbers, std::uint32_t gaps = 0) {
    std::string bytes = bits(static_cast<std::uint32_t>(numbers.size() / 2)) + bits(gaps);
    for (const float number : numbers)
        bytes += bits(number);
    return bytes;
}

const std::string square = contour({0, 0, 10, 0, 10, 10, 0, 10, 0, 0});
const std::string end_at_one = bits(1.0F) + bits(0xFFFFFFFFU);

std::string two_layers() {
    return bits(0.0F) + bits(1U) + square + bits(0.5F) + bits(1U) + square + end_at_one;
}

void expect_square(const LayerFile& file, double scale = 1) {
    const std::vector<LayerPart> parts = file.in_memory();
    ASSERT_EQ(file.parts.size(), 1U);
    const LayerStack& layers = parts.front().layers;
    ASSERT_EQ(layers.size(), 2U);
    EXPECT_DOUBLE_EQ(measure(layers[1]).area_mm2, 100 * scale * scale);
    EXPECT_DOUBLE_EQ(layers[0].bottom, 0);
    EXPECT_DOUBLE_EQ(layers[0].z, 0.25 * scale);
    EXPECT_DOUBLE_EQ(layers[1].bottom, 0.5 * scale);
    EXPECT_DOUBLE_EQ(layers[1].top, 1 * scale);
}

TEST(ReadSlc, HeightsAreBottomsAndTheEndIsTheTop) {
    const LayerFile file = read(header() + two_layers());
    expect_square(file);
    EXPECT_TRUE(file.warnings.empty());
}

TEST(ReadSlc, HeadersOfOthersAreUnderstood) {
    expect_square(read(header("-slcver2.0-unitMM") + two_layers()));
    expect_square(read(header("-SLCVER 2.0\r\n-UNITS INCH\r\n-PACKAGE A-B ", "\x1a") + two_layers()), 25.4);
    EXPECT_EQ(read(header("-SLCVER 2.0 ") + two_layers()).warnings.size(), 1U);
}

TEST(ReadSlc, WhatIsOddIsReported) {
    const std::string layer = bits(0.0F) + bits(1U);
    EXPECT_EQ(read(header() + layer + square).warnings.size(), 1U); // no end
    EXPECT_EQ(read(header() + layer + square + bits(0.0F) + bits(0xFFFFFFFFU)).warnings.size(),
              1U); // end too low
    const LayerFile open = read(header() + layer + contour({0, 0, 1, 0, 1, 1}) + end_at_one);
    const std::vector<LayerPart> open_parts = open.in_memory();
    EXPECT_EQ(open.warnings.size(), 1U);
    EXPECT_EQ(open_parts.front().layers.front().rings, 1U);
    const LayerFile web =
        read(header("-SLCVER 2.0 -UNIT MM -TYPE WEB ") + layer + contour({0, 0, 1, 0, 1, 1}) + end_at_one);
    const std::vector<LayerPart> web_parts = web.in_memory();
    EXPECT_EQ(web_parts.front().layers.front().open_chains(), 1U);
    EXPECT_TRUE(web.warnings.empty());
}

TEST(ReadSlc, WhatFollowsTheEndIsReported) {
    const std::string whole = header() + two_layers();
    const LayerFile file = read(whole + "more");
    expect_square(file);
    EXPECT_EQ(file.warnings,
              std::vector<std::string>{"4 bytes follow the mark of the end, from byte " +
                                       std::to_string(whole.size()) + " on; they were left out"});
}

TEST(ReadSlc, SupportsAreMarked) {
    EXPECT_FALSE(read(header() + two_layers()).parts.at(0).support);
    EXPECT_TRUE(read(header("-SLCVER 2.0 -UNIT MM -TYPE SUPPORT ") + two_layers()).parts.at(0).support);
}

TEST(ReadSlc, TheOthersOfThatNameAreNamed) {
    EXPECT_NE(error_of("Slice V01\nZ 0.1 0.1\n").find("Stratasys"), std::string::npos);
    EXPECT_NE(error_of("11111\n10 10 10 8\n").find("voxels"), std::string::npos);
}

TEST(ReadSlc, ClaimsAreChecked) {
    EXPECT_NE(error_of(header() + bits(0.0F) + bits(7U)).find("7 contours"), std::string::npos);
    EXPECT_NE(error_of(header() + bits(0.0F) + bits(1U) + bits(9U) + bits(0U)).find("9 points"),
              std::string::npos);
    EXPECT_NE(error_of(header().substr(0, 100)).find("256"), std::string::npos);
    std::string none = header();
    none[none.size() - 17] = 0;
    EXPECT_NE(error_of(none).find("no entries"), std::string::npos);
    EXPECT_NE(error_of(header() + end_at_one).find("no layer"), std::string::npos);
    const float nan = std::nanf("");
    EXPECT_NE(error_of(header() + bits(nan) + bits(0U)).find("not finite"), std::string::npos);
    EXPECT_NE(error_of(header() + bits(0.0F) + bits(1U) + contour({nan, 0, 1, 0, 1, 1})).find("not finite"),
              std::string::npos);
}

} // namespace
} // namespace lamella::slc_cases
