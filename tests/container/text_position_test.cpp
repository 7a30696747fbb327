#include "container/text_position.hpp"

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

} // namespace
} // namespace lamella
