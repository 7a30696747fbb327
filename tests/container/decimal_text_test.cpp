#include "container/decimal_text.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

namespace lamella {
namespace {

/// The number that is the whole text, "none" as NaN.
double whole(const std::string& text) {
    double value = 0;
    const char* const end = text.data() + text.size();
    return read_decimal(text.data(), end, value) == end ? value : std::nan("");
}

TEST(DecimalText, ReadsEveryWayToWriteANumber) {
    for (const char* text : {"1", "+1", "1.", "01", "1.0", "1e0", "1E+0", "10e-1", ".1e1", "0.1e+1",
                             "1000000000000000000000e-21", "0.00000000000000000000000000000000000001e38"})
        EXPECT_EQ(whole(text), 1) << text;
    EXPECT_EQ(whole("-.5"), -0.5);
    EXPECT_FALSE(std::signbit(whole("-0")));
    EXPECT_FALSE(std::signbit(whole("-1e-400")));
    EXPECT_EQ(whole("1e-400"), 0);
    EXPECT_EQ(whole("0e999999999999999999999"), 0);
    EXPECT_EQ(whole("0.0000000001e-99999999999999999999"), 0);
    for (const char* text : {"", "-", "+", ".", "e5", "1e", "1e+", "1,5", "nan", "inf", "0x1", "1.5.5", "--1",
                             "+-1", "1e400", "-1e400", "123456789e9999999999999999", " 1", "1 "})
        EXPECT_TRUE(std::isnan(whole(text))) << text;
}

TEST(DecimalText, StopsBehindTheNumber) {
    const std::string text = "12.5\"/>";
    double value = 0;
    EXPECT_EQ(read_decimal(text.data(), text.data() + text.size(), value), text.data() + 4);
    EXPECT_EQ(value, 12.5);
    std::uint32_t index = 0;
    EXPECT_EQ(read_index(text.data(), text.data() + text.size(), index), text.data() + 2);
    EXPECT_EQ(index, 12U);
}

TEST(DecimalText, IndicesHave32Bits) {
    const auto read = [](const std::string& text) -> std::int64_t {
        std::uint32_t index = 0;
        const char* const end = text.data() + text.size();
        return read_index(text.data(), end, index) == end ? std::int64_t{index} : -1;
    };
    EXPECT_EQ(read("0"), 0);
    EXPECT_EQ(read("0004294967295"), 4294967295);
    for (const char* text : {"", "-1", "+1", "4294967296", "99999999999999999999999", "1.0", "x"})
        EXPECT_EQ(read(text), -1) << text;
}

// The standard library rounds correctly.
TEST(DecimalText, AgreesWithTheStandardLibrary) {
    std::mt19937_64 random(20'25);
    for (int round = 0; round < 200'000; ++round) {
        std::string text = random() % 2 != 0 ? "-" : "";
        const auto digits = [&](std::size_t count) {
            for (std::size_t i = 0; i < count; ++i)
                text.push_back(static_cast<char>('0' + random() % 10));
        };
        digits(1 + random() % (random() % 8 == 0 ? 30 : 8));
        if (random() % 4 != 0) {
            text.push_back('.');
            digits(1 + random() % (random() % 8 == 0 ? 30 : 8));
        }
        if (random() % 4 == 0) {
            text.append("e").append(random() % 2 != 0 ? "-" : "");
            digits(1 + random() % 3);
        }
        const double expected = std::strtod(text.c_str(), nullptr);
        if (std::isinf(expected))
            EXPECT_TRUE(std::isnan(whole(text))) << text;
        else
            EXPECT_EQ(whole(text), expected + 0.0) << text;
    }
}

} // namespace
} // namespace lamella
