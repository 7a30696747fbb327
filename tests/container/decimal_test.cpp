#include "container/decimal.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace lamella {
namespace {

std::vector<std::int64_t> telling_integers() {
    std::vector<std::int64_t> values{0, std::numeric_limits<std::int64_t>::max(),
                                     std::numeric_limits<std::int64_t>::min(),
                                     std::numeric_limits<std::int64_t>::min() + 1};
    for (std::int64_t power = 1; power <= 1'000'000'000'000'000'000 / 10; power *= 10) {
        for (std::int64_t d = -11; d <= 11; ++d)
            values.insert(values.end(), {power + d, -(power + d), 9 * power + d});
    }
    std::mt19937_64 random(1);
    for (int i = 0; i < 20'000; ++i)
        values.push_back(static_cast<std::int64_t>(random() >> (random() % 64)));
    return values;
}

template <class Put>
std::string text_of(const Put& put, std::int64_t n) {
    char buffer[32];
    return {buffer, put(buffer, n)};
}

TEST(PutInteger, AgreesWithAnIndependentFormatter) {
    const auto put = [](char* out, std::int64_t n) {
        return put_integer(out, n);
    };
    for (const std::int64_t n : telling_integers())
        ASSERT_EQ(text_of(put, n), fmt::format("{}", n));
}

TEST(PutInteger, CountsTheDigitsOfEveryPowerOfTen) {
    std::uint64_t power = 1;
    for (unsigned digits = 1; digits <= 20; ++digits) {
        EXPECT_EQ(digit_count(power), digits);
        EXPECT_EQ(digit_count(power - 1), digits == 1 ? 1 : digits - 1);
        power *= 10;
    }
    EXPECT_EQ(digit_count(std::numeric_limits<std::uint64_t>::max()), 20U);
}

TEST(PutThousandths, WritesTheFewestDecimals) {
    EXPECT_EQ(text_of(put_thousandths, 0), "0");
    EXPECT_EQ(text_of(put_thousandths, 12345), "12.345");
    EXPECT_EQ(text_of(put_thousandths, 12340), "12.34");
    EXPECT_EQ(text_of(put_thousandths, 12300), "12.3");
    EXPECT_EQ(text_of(put_thousandths, 12000), "12");
    EXPECT_EQ(text_of(put_thousandths, -5), "-0.005");
    EXPECT_EQ(text_of(put_thousandths, 100), "0.1");
}

TEST(PutThousandths, AgreesWithAnIndependentFormatter) {
    for (const std::int64_t n : telling_integers()) {
        if (n < -1'000'000'000'000 || n > 1'000'000'000'000)
            continue;
        std::string expected = fmt::format("{:.3f}", static_cast<double>(n) / 1000);
        expected.erase(expected.find_last_not_of('0') + 1);
        if (expected.back() == '.')
            expected.pop_back();
        ASSERT_EQ(text_of(put_thousandths, n), expected);
    }
}

TEST(DecimalText, RoundsAndTrimsButNeverWritesAnExponentOrANegativeZero) {
    EXPECT_EQ(decimal_text(12.5, 6, 6), "12.500000");
    EXPECT_EQ(decimal_text(12.5, 6, 1), "12.5");
    EXPECT_EQ(decimal_text(50, 6, 1), "50.0");
    EXPECT_EQ(decimal_text(50, 6, 0), "50");
    EXPECT_EQ(decimal_text(100, 3, 0), "100");
    EXPECT_EQ(decimal_text(-1e-9, 6, 1), "0.0");
    EXPECT_EQ(decimal_text(-0.0, 3, 0), "0");
    EXPECT_EQ(decimal_text(1e20, 3, 1), "100000000000000000000.0");
    EXPECT_EQ(decimal_text(1e-7, 9, 4), "0.0000001");
}

TEST(ExactDecimalText, ReadsBackAndHasADecimalPoint) {
    EXPECT_EQ(exact_decimal_text(0.001), "0.001");
    EXPECT_EQ(exact_decimal_text(1), "1.0");
    EXPECT_EQ(exact_decimal_text(1e-9), "0.000000001");
    EXPECT_EQ(std::stod(exact_decimal_text(1.0 / 3)), 1.0 / 3);
}

template <class Number>
std::string portable_text(Number value, bool exponents = true) {
    char buffer[2000];
    return {buffer, detail::put_shortest_without_library(buffer, value, exponents)};
}

/// Numbers of any exponent, and numbers with few digits.
std::vector<double> telling_numbers() {
    std::vector<double> values{0.0,
                               -0.0,
                               std::numeric_limits<double>::max(),
                               std::numeric_limits<double>::denorm_min(),
                               9007199254740993.0,
                               0.1,
                               1e5,
                               1e-4};
    std::mt19937_64 random(1);
    for (int i = 0; i < 20'000; ++i) {
        const std::uint64_t bits = random();
        double value = 0;
        std::memcpy(&value, &bits, sizeof value);
        if (std::isfinite(value))
            values.push_back(value);
        values.push_back(
            std::ldexp(static_cast<double>(static_cast<std::int64_t>(random()) >> (random() % 60)),
                       static_cast<int>(random() % 80) - 40));
        values.push_back(static_cast<double>(random() % 1000) *
                         std::pow(10, static_cast<int>(random() % 40) - 20));
    }
    return values;
}

TEST(PutShortest, WritesTheSameTextsWithoutTheStandardLibrary) {
    char buffer[2000];
    const auto fixed = std::chars_format::fixed;
    const auto text = [&](auto... arguments) {
        return std::string(buffer, std::to_chars(buffer, std::end(buffer), arguments...).ptr);
    };
    for (const double value : telling_numbers()) {
        ASSERT_EQ(portable_text(value), text(value));
        ASSERT_EQ(portable_text(value, false), text(value, fixed));
        const auto single = static_cast<float>(value);
        ASSERT_EQ(portable_text(single), text(single));
        ASSERT_EQ(portable_text(single, false), text(single, fixed));
        if (const std::string rounded = text(value, fixed, 6); rounded != "-0.000000") {
            ASSERT_EQ(decimal_text(value, 6, 6), rounded);
        }
    }
}

} // namespace
} // namespace lamella
