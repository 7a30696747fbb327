#include "container/base64.hpp"

#include <gtest/gtest.h>

#include <string>
#include <string_view>

namespace lamella {
namespace {

std::string base64(std::string_view bytes) {
    std::string text = "before ";
    append_base64(bytes, text);
    EXPECT_EQ(text.size(), 7 + base64_size(bytes.size()));
    return text.substr(7);
}

TEST(Base64, IsThatOfTheStandard) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64({"\xff\xfe\x00\x10", 4}), "//4AEA==");
}

} // namespace
} // namespace lamella
