#include "container/text_place.hpp"

#include <gtest/gtest.h>

namespace lamella {
namespace {

TEST(LineAt, CountsEveryKindOfLineEndOnce) {
    for (const std::string_view end : {"\n", "\r\n", "\r"}) {
        const std::string text = "one" + std::string(end) + std::string(end) + "three";
        EXPECT_EQ(line_at(text, 0), 1U);
        EXPECT_EQ(line_at(text, 2), 1U);
        EXPECT_EQ(line_at(text, text.find("three")), 3U);
        EXPECT_EQ(line_at(text, text.size()), 3U);
    }
}

TEST(LineAt, TakesAPlaceBeyondTheEndForTheEnd) {
    EXPECT_EQ(line_at("a\nb", 100), 2U);
    EXPECT_EQ(line_at("", 0), 1U);
    EXPECT_EQ(line_at("a\r", 2), 2U);
}

TEST(Printable, KeepsTextOfAnyLanguage) {
    EXPECT_EQ(printable("20mmbox-čřšřěá 部品 🦑", 100), "20mmbox-čřšřěá 部品 🦑");
}

TEST(Printable, ShowsWhatIsNotTextAsBytes) {
    EXPECT_EQ(printable(std::string_view("a\0b\n\x7F", 5), 100), "a\\x00b\\x0a\\x7f");
    EXPECT_EQ(printable("St\xFC\x63k", 100), "St\\xfcck");
    EXPECT_EQ(printable("\xC2\x85", 100), "\\xc2\\x85") << "a control character in two bytes";
    EXPECT_EQ(printable("\xE2\x82", 100), "\\xe2\\x82") << "cut in the middle of a character";
    EXPECT_EQ(printable("a\xEF\xBF\xBF\xEF\xBF\xBE\xEF\xBF\xBD", 100),
              "a\\xef\\xbf\\xbf\\xef\\xbf\\xbe\xEF\xBF\xBD")
        << "no characters, of which XML must have none";
    EXPECT_EQ(printable("\xC0\xAF\xED\xA0\x80", 100), "\\xc0\\xaf\\xed\\xa0\\x80") << "overlong, surrogate";
}

TEST(Printable, CutsLongTextAtACharacter) {
    EXPECT_EQ(printable("abcdef", 6), "abcdef");
    EXPECT_EQ(printable("abcdefg", 6), "abcdef...");
    EXPECT_EQ(printable("abcdeé", 6), "abcde...");
}

} // namespace
} // namespace lamella
