#include "container/coordinate_text.hpp"
#include "fixtures/random.hpp"
#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

namespace lamella::coordinate_text_cases {
namespace {

using test::Random;

/// Returns the number, if the word is one as a whole.
template <class T>
std::optional<T> parsed(const std::string& text) {
    T value = 0;
    const char* const end = text.data() + text.size();
    const char* const stop = parse_coordinate(text.data(), end, value);
    if (stop == nullptr)
        return std::nullopt;
    EXPECT_EQ(std::string_view(text.data(), static_cast<std::size_t>(stop - text.data())),
              word_at(text.data(), end));
    return value;
}

std::string random_number(Random& random) {
    std::string text;
    if (random.integer(0, 1) == 0)
        text += '-';
    const std::int64_t digits = random.integer(1, 25);
    const std::int64_t point = random.integer(-5, digits);
    for (std::int64_t i = 0; i < digits; ++i) {
        if (i == point)
            text += '.';
        text += static_cast<char>('0' + random.integer(0, 9));
    }
    if (random.integer(0, 2) == 0)
        text += "e" + std::to_string(random.integer(-330, 310));
    return text;
}

template <class T>
void expect_as_strtod(const std::string& text) {
    char* stop = nullptr;
    errno = 0;
    const T expected = std::is_same_v<T, float> ? static_cast<T>(std::strtof(text.c_str(), &stop))
                                                : static_cast<T>(std::strtod(text.c_str(), &stop));
    const bool in_range = errno == 0;
    ASSERT_EQ(stop, text.c_str() + text.size()) << text;
    const std::optional<T> value = parsed<T>(text);
    ASSERT_TRUE(value) << text;
    if (in_range)
        EXPECT_EQ(*value, expected) << text;
    else // too large, or too small
        EXPECT_TRUE(std::isinf(*value) || std::abs(*value) < 1e-37) << text << ' ' << *value;
}

TEST(CoordinateText, RoundsEachNumberOnce) {
    Random random(501);
    for (int round = 0; round < test::rounds_within_reason(100'000); ++round) {
        const std::string text = random_number(random);
        expect_as_strtod<double>(text);
        expect_as_strtod<float>(text);
    }
}

TEST(CoordinateText, RoundsNumbersHalfWayBetweenTwoFloatsOnce) {
    Random random(502);
    for (int round = 0; round < test::rounds_within_reason(10'000); ++round) {
        const auto low = static_cast<float>(random.real(1, 2));
        const double half = (double{low} + double{std::nextafter(low, 3.0F)}) / 2;
        char text[64];
        for (const double value : {half, std::nextafter(half, 0.0), std::nextafter(half, 3.0)}) {
            const auto printed = std::to_chars(text, text + sizeof text, value);
            expect_as_strtod<float>(std::string(text, printed.ptr));
        }
    }
}

TEST(CoordinateText, TakesTheSpellingsOfFiles) {
    EXPECT_EQ(parsed<double>("1."), 1.0);
    EXPECT_EQ(parsed<double>(".5"), 0.5);
    EXPECT_EQ(parsed<double>("+2.5E-3"), 0.0025);
    EXPECT_EQ(parsed<double>("7 8"), 7.0);
    EXPECT_EQ(parsed<double>("7\n"), 7.0);
    for (const std::string nan : {"nan", "-NaN", "inf", "-Infinity", "1.#QNAN", "-1.#IND"})
        EXPECT_TRUE(std::isnan(parsed<double>(nan).value_or(0)) && std::isnan(parsed<float>(nan).value_or(0)))
            << nan;
    EXPECT_TRUE(std::isinf(parsed<float>("1e39").value_or(0)));
}

TEST(CoordinateText, RefusesWordsThatAreNoNumbers) {
    for (const std::string word :
         {"x", "1,5", "--1", "+-1", "1.2.3", "0x10", "1e", "1e+", "-", "+", ".", "e5", "5mm", "1_000"}) {
        EXPECT_FALSE(parsed<double>(word)) << word;
        EXPECT_FALSE(parsed<float>(word)) << word;
    }
    EXPECT_EQ(expected_instead("1,5"), "a number with a decimal point and no comma");
    EXPECT_EQ(expected_instead("x"), "a number");
}

TEST(CoordinateText, ReadsExponentsAfterADAsFortranWritesThem) {
    EXPECT_EQ(parsed<double>("1D-3"), 1e-3);
    EXPECT_EQ(parsed<float>("-2.5d+2"), -250.0F);
    EXPECT_EQ(parsed<double>("+1.D1"), 10.0);
    for (const char* word : {"D3", "1D", "1D-", "1D3x", "1D3D3", "1e3D3", "d", "-D1"})
        EXPECT_EQ(parsed<double>(word), std::nullopt) << word;
    EXPECT_EQ(parsed<double>("1D" + std::string(100, '0')), std::nullopt);
}

} // namespace
} // namespace lamella::coordinate_text_cases
