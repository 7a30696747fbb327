#include "lamella/core/printable.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace lamella {
namespace {

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

TEST(Printable, ShowsControlsOfLinesAndOfTheDirectionOfTextAsBytes) {
    EXPECT_EQ(printable("part\xE2\x80\xAEgpj.stl"), "part\\xe2\\x80\\xaegpj.stl");
    for (const char* control : {"\xD8\x9C", "\xE2\x80\x8E", "\xE2\x80\x8F", "\xE2\x80\xA8", "\xE2\x80\xA9",
                                "\xE2\x80\xAA", "\xE2\x81\xA6", "\xE2\x81\xA9"})
        EXPECT_NE(printable(control), control);
    for (const char* other : {"\xD8\x9B", "\xD9\x9C", "\xE2\x80\x8D", "\xE2\x80\x90", "\xE2\x80\xA7",
                              "\xE2\x80\xAF", "\xE2\x81\xA5", "\xE2\x81\xAA", "\xE2\x82\xA8"})
        EXPECT_EQ(printable(other), other);
}

TEST(Utf8, IsWhatIsWellFormed) {
    for (const char* text :
         {"", "a", "\xC3\xA4", "\xE2\x82\xAC", "\xF0\x9F\x99\x82", "\x01\x7f\xC2\x85", "\xEF\xBF\xBF"})
        EXPECT_TRUE(is_utf8(text)) << printable(text);
    for (const char* text : {"\xff", "a\xC3", "\xC0\xAF", "\xED\xA0\x80", "\xF4\x90\x80\x80", "\x80"})
        EXPECT_FALSE(is_utf8(text)) << printable(text);
}

TEST(Printable, CutsLongTextAtACharacter) {
    EXPECT_EQ(printable("abcdef", 6), "abcdef");
    EXPECT_EQ(printable("abcdefg", 6), "abcdef...");
    EXPECT_EQ(printable("abcdeé", 6), "abcde...");
}

TEST(Printable, LeavesWhatItMadeAsItIs) {
    const std::string once = printable("\x1b[31m\xe4\xc2\x85");
    EXPECT_EQ(once, "\\x1b[31m\\xe4\\xc2\\x85");
    EXPECT_EQ(printable(once), once);
}

TEST(Excerpt, EndsAfterTwoHundredBytes) {
    EXPECT_EQ(excerpt(std::string(200, 'x')), std::string(200, 'x'));
    EXPECT_EQ(excerpt(std::string(70'000, 'x')), std::string(200, 'x') + "...");
}

} // namespace
} // namespace lamella
