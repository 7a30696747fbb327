#include "slices/images/preview.hpp"

#include <gtest/gtest.h>

#include <string>

namespace lamella::preview_cases {
namespace {

/// A square of one colour.
ColourImage square_of(std::uint8_t red, std::uint8_t green, std::uint8_t blue, std::uint8_t alpha = 255) {
    ColourImage image{8, 8, {}};
    for (int i = 0; i < 64; ++i)
        image.values.insert(image.values.end(), {red, green, blue, alpha});
    return image;
}

TEST(Preview, HasItsPartInTheMiddleBeforeBlack) {
    const std::string big = preview_565(square_of(255, 128, 8), 20, 20, ByteOrder::big);
    const std::string little = preview_565(square_of(255, 128, 8), 20, 20, ByteOrder::little);
    ASSERT_EQ(big.size(), 800U);
    ASSERT_EQ(little.size(), 800U);
    EXPECT_EQ(big.substr(0, 2), std::string(2, '\0'));
    EXPECT_EQ(big.substr(2 * (10 * 20 + 10), 2), "\xFC\x01"); // 31, 32, 1
    EXPECT_EQ(little.substr(2 * (10 * 20 + 10), 2), "\x01\xFC");
    EXPECT_EQ(preview_565(square_of(255, 255, 255, 128), 20, 20, ByteOrder::big).substr(420, 2), "\x84\x10");
}

TEST(Preview, HasRunsOfEqualPixels) {
    // Black up to the square, its first row, and so on; each run has a flag in the lowest bit of green.
    const std::string runs = preview_runs(square_of(255, 128, 8), 20, 20);
    EXPECT_EQ(runs.substr(0, 8), std::string("\x20\x00\x7D\x30\x21\xFC\x07\x30", 8));
    // 10,000 black pixels are divided: a run has at most 4095.
    const std::string black = preview_runs(square_of(0, 0, 0, 0), 100, 100);
    EXPECT_EQ(black, std::string("\x20\x00\xFE\x3F\x20\x00\xFE\x3F\x20\x00\x11\x37", 12));
    EXPECT_EQ(preview_runs(square_of(0, 0, 0, 0), 1, 1), std::string(2, '\0'));
}

} // namespace
} // namespace lamella::preview_cases
