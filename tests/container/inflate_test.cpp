#include "container/deflate.hpp"
#include "container/inflate.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace lamella::inflate_cases {
namespace {

std::string compressed(std::string_view text) {
    std::string stream;
    Deflater().append_chunk(text, stream);
    return stream.append(deflate_end);
}

/// What unpacking into a room of this size gives, and the text.
std::pair<Inflated, std::string> unpacked(std::string_view stream, std::size_t size) {
    std::vector<std::byte> room(size);
    const Inflated result = inflate(stream, room);
    return {result, std::string(reinterpret_cast<const char*>(room.data()), size)};
}

TEST(Inflate, GivesBackWhatWasPacked) {
    for (const std::size_t size : std::vector<std::size_t>{1, 100, 70'000, 3'000'000}) {
        std::string text;
        for (std::size_t i = 0; i < size; ++i)
            text.push_back(static_cast<char>(i * i / 7));
        EXPECT_EQ(unpacked(compressed(text), size), std::pair(Inflated::whole, text));
    }
    EXPECT_EQ(unpacked(compressed(""), 0).first, Inflated::whole);
}

TEST(Inflate, SaysHowTheRoomIsWrong) {
    const std::string stream = compressed("some text");
    EXPECT_EQ(unpacked(stream, 10).first, Inflated::too_short);
    EXPECT_EQ(unpacked(stream, 8).first, Inflated::too_long);
    EXPECT_EQ(unpacked(stream, 0).first, Inflated::too_long);
    EXPECT_EQ(unpacked(compressed(""), 1).first, Inflated::too_short);
}

TEST(Inflate, RefusesWhatIsBroken) {
    const std::string stream = compressed("some text that is long enough");
    EXPECT_EQ(unpacked(stream + "x", 29).first, Inflated::broken);
    EXPECT_EQ(unpacked("", 1).first, Inflated::broken);
    EXPECT_EQ(unpacked(std::string(50, '\xff'), 1).first, Inflated::broken);
    for (std::size_t size = 0; size < stream.size(); ++size)
        EXPECT_NE(unpacked(stream.substr(0, size), 29).first, Inflated::whole) << size;
}

} // namespace
} // namespace lamella::inflate_cases
