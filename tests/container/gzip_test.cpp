#include "lamella/core/error.hpp"

#include "container/gzip.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/random.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <string>
#include <string_view>

namespace lamella::gzip_cases {
namespace {

/// A member of a gzip file, as zlib makes it.
std::string compressed(std::string_view bytes) {
    z_stream stream{};
    constexpr int gzip_window = 15 + 16;
    EXPECT_EQ(deflateInit2(&stream, 6, Z_DEFLATED, gzip_window, 8, Z_DEFAULT_STRATEGY), Z_OK);
    std::string out(deflateBound(&stream, static_cast<uLong>(bytes.size())), '\0');
    std::string in(bytes);
    stream.next_in = reinterpret_cast<Bytef*>(in.data());
    stream.avail_in = static_cast<uInt>(in.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    EXPECT_EQ(deflate(&stream, Z_FINISH), Z_STREAM_END);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    return out;
}

ByteSource source(std::string_view bytes) {
    return copy_bytes(std::as_bytes(std::span(bytes.data(), bytes.size())), "part.gz");
}

std::string content(std::string_view bytes, std::uint64_t max_bytes = 0) {
    const ByteSource out = unpacked(source(bytes), max_bytes);
    EXPECT_EQ(out.name, "part.gz");
    return {reinterpret_cast<const char*>(out.bytes.data()), out.bytes.size()};
}

std::string error_of(std::string_view bytes, std::uint64_t max_bytes = 0, ErrorKind kind = ErrorKind::input) {
    return test::error_of(kind, [&] { (void)content(bytes, max_bytes); });
}

/// Text that packs neither well nor badly.
std::string some_text(std::size_t size) {
    test::Random random(1);
    std::string text;
    while (text.size() < size)
        text += std::to_string(random.integer(0, 999)) + "\n";
    return text;
}

TEST(Gzip, IsReportedByItsFirstBytes) {
    EXPECT_TRUE(is_gzip(source(compressed("x")).bytes));
    EXPECT_FALSE(is_gzip(source("solid").bytes));
    EXPECT_FALSE(is_gzip(source("\x1f\x8b").bytes));
}

TEST(Gzip, UnpacksOneMemberOrSeveral) {
    const std::string text = some_text(18'000'000); // more than two steps of the reader
    EXPECT_TRUE(content(compressed(text)) == text);
    EXPECT_EQ(content(compressed("one ") + compressed("") + compressed("two")), "one two");
    EXPECT_EQ(content(compressed("one") + std::string(100, '\0')), "one");
}

TEST(Gzip, DoesNotBelieveTheSizeInTheFile) {
    std::string small = compressed("one");
    small.replace(small.size() - 4, 4, "\xff\xff\xff\xff");
    EXPECT_NE(error_of(small).find("are damaged (incorrect length check)"), std::string::npos);
    std::string wrong = compressed("one");
    wrong[wrong.size() - 6] ^= 1;
    EXPECT_NE(error_of(wrong).find("are damaged (incorrect data check)"), std::string::npos);
}

TEST(Gzip, StopsAtTheLimit) {
    const std::string bomb = compressed(std::string(8'000'000, '\0'));
    EXPECT_LT(bomb.size(), 80'000U);
    EXPECT_EQ(error_of(bomb, 1'000'000, ErrorKind::limit),
              "part.gz: unpacks to more than the 1000000 bytes that `max_memory` leaves it");
    EXPECT_EQ(content(bomb, 8'000'000).size(), 8'000'000U);
}

TEST(Gzip, UnpacksSmallFilesToNoMoreThanTheyAreMeantToUnlessAsked) {
    const std::string bomb = compressed(std::string(100'000'000, '\0'));
    EXPECT_LT(bomb.size(), 200'000U);
    EXPECT_NE(error_of(bomb, 0, ErrorKind::limit).find("unpacks to more than 67108864 bytes"),
              std::string::npos);
    EXPECT_EQ(content(bomb, 200'000'000).size(), 100'000'000U);
}

TEST(Gzip, NamesTheByteOfADefect) {
    const std::string whole = compressed("a text");
    for (std::size_t size = 3; size < whole.size(); ++size)
        EXPECT_NE(error_of(whole.substr(0, size)).find("cut off"), std::string::npos) << size;
    EXPECT_EQ(error_of(whole + "garbage"),
              "part.gz: byte " + std::to_string(whole.size()) +
                  ": something else follows the gzip data, expected the end of the file");
    EXPECT_NE(error_of(compressed("")).find("the gzip file is empty"), std::string::npos);
}

TEST(Gzip, SurvivesMutations) {
    const std::string whole = compressed(some_text(300)) + compressed("more");
    test::Random random(2);
    for (int round = 0; round < 3000; ++round) {
        std::string bytes = whole;
        for (int change = 0; change < 2; ++change)
            bytes[static_cast<std::size_t>(random.integer(3, static_cast<std::int64_t>(bytes.size()) - 1))] =
                static_cast<char>(random.bits());
        try {
            (void)unpacked(source(bytes), 1'000'000);
        } catch (const Error& error) {
            EXPECT_TRUE(error.kind() == ErrorKind::input || error.kind() == ErrorKind::limit);
        }
    }
}

TEST(Gzip, EndsWhenAskedTo) {
    CancelFlag stop;
    stop.request();
    test::error_of(ErrorKind::cancelled,
                   [&] { (void)unpacked(source(compressed("x")), 0, {.cancel = &stop}); });
}

TEST(Gzip, MembersAreReadBackAndJoinedByConcatenation) {
    EXPECT_EQ(gzip_member(""), "");
    std::string all;
    std::string members;
    for (const std::size_t size : {1U, 64U, 65U, 100'000U}) {
        const std::string bytes(size, 'a');
        EXPECT_EQ(content(gzip_member(bytes)), bytes);
        EXPECT_EQ(gzip_member(bytes), gzip_member(bytes));
        all += bytes;
        members += gzip_member(bytes);
    }
    EXPECT_EQ(content(members), all);
    EXPECT_LT(members.size(), all.size() / 10);
}

TEST(Gzip, NamesEndWithGzInAnyCase) {
    EXPECT_TRUE(has_gzip_extension("part.svg.gz") && has_gzip_extension("PART.CLI.GZ"));
    EXPECT_FALSE(has_gzip_extension("gz") || has_gzip_extension("part.gz.svg") || has_gzip_extension(""));
}

} // namespace
} // namespace lamella::gzip_cases
