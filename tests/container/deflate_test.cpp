#include "container/deflate.hpp"
#include "container/inflate.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <random>
#include <string>
#include <string_view>

namespace lamella {
namespace {

// By zlib's own inflate; what does not end with the stream's end fails.
std::string inflated(std::string_view stream, std::size_t size) {
    std::string out(size + 1, '\0');
    z_stream state{};
    EXPECT_EQ(inflateInit2(&state, -15), Z_OK);
    state.next_in = const_cast<Bytef*>(reinterpret_cast<const Bytef*>(stream.data()));
    state.avail_in = static_cast<uInt>(stream.size());
    state.next_out = reinterpret_cast<Bytef*>(out.data());
    state.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(inflate(&state, Z_FINISH), Z_STREAM_END);
    EXPECT_EQ(state.avail_in, 0U);
    out.resize(state.total_out);
    inflateEnd(&state);
    return out;
}

std::string noise(std::size_t size) {
    std::mt19937 random(1);
    std::string text(size, '\0');
    for (char& c : text)
        c = static_cast<char>(random());
    return text;
}

TEST(Deflate, PiecesOfSeveralDeflatersJoinToOneStream) {
    std::string text;
    std::string stream;
    Deflater even;
    Deflater odd;
    for (int i = 0; i < 40; ++i) {
        const std::string chunk =
            i % 7 == 3 ? noise(100'000) : std::string(static_cast<std::size_t>(i * i), 'x');
        (i % 2 == 0 ? even : odd).append_chunk(chunk, stream);
        text += chunk;
    }
    stream += deflate_end;
    EXPECT_EQ(inflated(stream, text.size()), text);
    EXPECT_EQ(inflated(deflate_end, 0), "");
}

TEST(Deflate, AUsedDeflaterMakesTheSamePieceAsAFreshOne) {
    const std::string text = "<vertex x=\"1.250\" y=\"3.500\"/>";
    Deflater used;
    std::string first;
    used.append_chunk(noise(50'000), first);
    std::string second;
    used.append_chunk(text, second);
    std::string fresh;
    Deflater().append_chunk(text, fresh);
    EXPECT_EQ(second, fresh);
}

TEST(Deflate, SumsAsPngFilesDo) {
    EXPECT_EQ(adler32_of("123456789"), 0x091E01DEU);
    EXPECT_EQ(adler32_of(""), 1U);
}

TEST(Deflate, JoinsCrcs) {
    EXPECT_EQ(crc32_of("123456789"), 0xCBF43926U); // the check value of the catalogues
    EXPECT_EQ(crc32_of(""), 0U);
    const std::string text = noise(10'000);
    const std::string_view view = text;
    for (const std::size_t cut : {0U, 1U, 5'000U, 9'999U, 10'000U})
        EXPECT_EQ(crc32_joined(crc32_of(view.substr(0, cut)), crc32_of(view.substr(cut)), view.size() - cut),
                  crc32_of(text));
}

} // namespace
} // namespace lamella
