#include "container/parse_number.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string_view>

namespace lamella {
namespace {

template <class Number>
void expect_number(std::string_view text, Number expected, std::size_t length) {
    Number value = 7;
    EXPECT_EQ(parse_number(text.data(), text.data() + text.size(), value), text.data() + length) << text;
    EXPECT_EQ(value, expected) << text;
}

TEST(ParseNumber, EndsWhereTheNumberDoes) {
    expect_number("12.5e1,3", 125.0, 6);
    expect_number("-.5 ", -0.5, 3);
    expect_number("1e", 1.0, 1);
    expect_number("0.1", 0.1F, 3);
}

TEST(ParseNumber, BeginsNowhereElseThanAtTheFirstCharacter) {
    for (const std::string_view text : {"", " 1", "+1", "x", "-"}) {
        double value = 7;
        EXPECT_EQ(parse_number(text.data(), text.data() + text.size(), value), text.data()) << text;
    }
}

TEST(ParseNumber, MakesWhatIsTooLargeInfiniteAndWhatIsTooSmallNothing) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    expect_number("1e400", infinity, 5);
    expect_number("-1e400", -infinity, 6);
    expect_number("1e-400", 0.0, 6);
    expect_number("1e39", std::numeric_limits<float>::infinity(), 4);
    expect_number("1e-60", 0.0F, 5);
}

} // namespace
} // namespace lamella
