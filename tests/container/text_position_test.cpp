#include "container/text_position.hpp"
#include "fixtures/random.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

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

TEST(LineCounter, CountsForthAndBack) {
    test::Random random(7);
    std::string text;
    for (int i = 0; i < 300; ++i)
        text += std::vector<std::string>{"\n", "\r\n", "\r", "text"}[random.integer(0, 3)];
    LineCounter lines(text);
    LineCounter from_middle(text, 200, line_at(text, 200));
    for (int i = 0; i < 200; ++i) {
        const auto offset =
            static_cast<std::size_t>(random.integer(0, static_cast<std::int64_t>(text.size())));
        EXPECT_EQ(lines.line(offset), line_at(text, offset));
        EXPECT_EQ(from_middle.line(offset), line_at(text, offset));
    }
}

} // namespace
} // namespace lamella
