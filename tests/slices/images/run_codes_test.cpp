#include "lamella/slices/layer_file.hpp"

#include "slices/images/run_codes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace lamella::run_codes_cases {
namespace {

std::string hex_of(std::string_view bytes) {
    std::string text;
    for (const char byte : bytes)
        text += fmt::format("{:02X} ", static_cast<unsigned char>(byte));
    return text.substr(0, text.empty() ? 0 : text.size() - 1);
}

/// One run, in hexadecimal.
std::string run_of(const RunCode& code, std::uint8_t value, std::uint64_t pixels) {
    ByteBuffer out;
    code.put(value, pixels, out);
    return hex_of(out.view());
}

/// The image that the description of the formats has as an example.
std::string example_in(const RunCode& code) {
    ByteBuffer out;
    RunEncoder encoder(code, out);
    encoder.add(std::vector<PixelRun>{{3, 0}, {4, 64}, {5, 128}, {8, 255}}, 1);
    encoder.add(std::vector<PixelRun>{{4, 255}, {6, 90}, {8, 0}}, 1);
    encoder.finish();
    return hex_of(out.view());
}

TEST(RunCodes, GiveTheBytesOfTheDescriptions) {
    EXPECT_EQ(example_in(goo_runs()), "55 03 41 40 41 80 C7 42 5A 02 55");
    EXPECT_EQ(example_in(ctb_runs()), "80 03 20 40 FF 07 AD 02 80 02");
    EXPECT_EQ(example_in(pw0_runs()), "00 03 41 81 F0 07 52 00 02");
    EXPECT_EQ(example_in(bit_runs(128)), "04 88 04");
    EXPECT_EQ(run_of(goo_runs(), 0, 9'115'106), "32 08 B1 5E");
    EXPECT_EQ(run_of(goo_runs(), 0x42, 1), "41 42");
    EXPECT_EQ(run_of(goo_runs(), 0x50, 181), "55 50 0B");
    EXPECT_EQ(run_of(goo_runs(), 255, 0xCCBBAA9), "F9 CC BB AA");
    EXPECT_EQ(run_of(ctb_runs(), 0, 1'690'750), "80 D9 CC 7E");
    EXPECT_EQ(run_of(ctb_runs(), 20, 1), "0A");
    EXPECT_EQ(run_of(ctb_runs(), 208, 1058), "E8 84 22");
    EXPECT_EQ(run_of(ctb_runs(), 255, 124), "FF 7C");
    EXPECT_EQ(run_of(pw0_runs(), 0, 4095), "0F FF");
    EXPECT_EQ(run_of(pw0_runs(), 15, 122), "F0 7A");
    EXPECT_EQ(run_of(pw0_runs(), 4, 1), "41");
}

TEST(RunCodes, DivideRunsThatAreTooLong) {
    EXPECT_EQ(run_of(goo_runs(), 0, (1U << 28) + 14), "3F FF FF FF 0F");
    EXPECT_EQ(run_of(ctb_runs(), 0, 1U << 28), "80 EF FF FF FF 00");
    EXPECT_EQ(run_of(pw0_runs(), 0, 4097), "0F FF 00 02");
    EXPECT_EQ(run_of(pw0_runs(), 9, 31), "9F 9F 91");
    EXPECT_EQ(run_of(bit_runs(1), 1, 250), "FD FD");
    EXPECT_EQ(run_of(bit_runs(1), 0, 251), "7D 7D 01");
}

TEST(RunCodes, HaveBlackAndWhiteFromAThreshold) {
    const RunCode code = bit_runs(191);
    EXPECT_EQ(code.joined[190], 0);
    EXPECT_EQ(code.joined[191], 1);
}

TEST(CtbCipher, XorsWithTheWordsOfItsDescription) {
    const auto words = [](std::uint32_t key, std::uint64_t layer) {
        std::string bytes(8, '\0');
        apply_ctb_cipher(key, layer, bytes.data(), bytes.size());
        return hex_of(bytes);
    };
    EXPECT_EQ(words(1, 0), "C3 DB 10 68 92 DD 3C 6E");
    EXPECT_EQ(words(0x12345678, 5), "EA 05 4F 79 AD 6A C7 CD");
    EXPECT_EQ(words(0, 5), "00 00 00 00 00 00 00 00");
    std::string image = "\x80\xD9\xCC\x7E\x0A\xE8\x84"; // of a file by CHITUBOX; the last word is cut
    apply_ctb_cipher(719487497, 0, image.data(), image.size());
    EXPECT_EQ(hex_of(image), "23 50 0B A0 D8 B8 DF");
    apply_ctb_cipher(719487497, 0, image.data(), image.size());
    EXPECT_EQ(hex_of(image), "80 D9 CC 7E 0A E8 84");
}

/// Limits of a file that does not exist.
ReadLimits any_limits() {
    return {ByteSource{}, LayerReadOptions{.max_memory = 1 << 30}};
}

/// The value of each pixel; "" at the end if all is well, or the fault.
std::pair<std::vector<int>, std::string> decoded(DecodeRuns& decode, std::string_view code,
                                                 std::uint32_t width = 8, std::uint32_t height = 2) {
    ReadLimits limits = any_limits();
    RunBuilder image(width, height, limits);
    const std::optional<RunFault> fault = decode(code, image);
    image.add(7, image.left());
    std::vector<int> values;
    std::uint64_t from = 0;
    for (const ImageRun& run : image.take().runs) {
        values.insert(values.end(), run.end - from, run.value);
        from = run.end;
    }
    return {values, fault ? fmt::format("{}: {}; {}", fault->at, fault->found, fault->expected) : ""};
}

std::string bytes_of(const std::vector<unsigned>& numbers) {
    std::string bytes;
    for (const unsigned number : numbers)
        bytes += static_cast<char>(number);
    return bytes;
}

/// A code of .goo with the right checksum.
std::string goo_of(const std::vector<unsigned>& chunks) {
    unsigned sum = 0;
    for (const unsigned chunk : chunks)
        sum += chunk;
    return "\x55" + bytes_of(chunks) + static_cast<char>(~sum & 0xffU);
}

TEST(RunCodes, AreDecodedAsTheDescriptionsSay) {
    const std::vector<int> exact{0, 0, 0, 64, 128, 255, 255, 255, 255, 255, 255, 255, 90, 90, 0, 0};
    using Values = std::vector<int>;
    EXPECT_EQ(
        decoded(decode_goo_runs, bytes_of({0x55, 3, 0x41, 0x40, 0x41, 0x80, 0xC7, 0x42, 0x5A, 2, 0x55})),
        std::pair(exact, std::string()));
    EXPECT_EQ(decoded(decode_ctb_runs, bytes_of({0x80, 3, 0x20, 0x40, 0xFF, 7, 0xAD, 2, 0x80, 2})).first,
              (Values{0, 0, 0, 65, 129, 255, 255, 255, 255, 255, 255, 255, 91, 91, 0, 0}));
    EXPECT_EQ(decoded(decode_pw0_runs, bytes_of({0, 3, 0x41, 0x81, 0xF0, 7, 0x52, 0, 2})).first,
              (Values{0, 0, 0, 68, 136, 255, 255, 255, 255, 255, 255, 255, 85, 85, 0, 0}));
    EXPECT_EQ(decoded(decode_bit_runs, bytes_of({4, 0x88, 4})).first,
              (Values{0, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255, 0, 0, 0, 0}));
}

TEST(RunCodes, OfGooMayHaveDifferences) {
    // 3 black; 5 more; 5 less for 4 pixels; 10 more than 0 for 2; then white and one less.
    EXPECT_EQ(
        decoded(decode_goo_runs, goo_of({3, 0x85, 0xB5, 4, 0x9A, 2, 0xC3, 0xA1, 0x02})),
        std::pair(std::vector<int>{0, 0, 0, 5, 0, 0, 0, 0, 10, 10, 255, 255, 255, 254, 0, 0}, std::string()));
    EXPECT_EQ(decoded(decode_goo_runs, goo_of({0xA1})).second,
              "1: a difference that leads to -1; values are 0 to 255");
}

TEST(RunCodes, SayWhereTheyAreBroken) {
    const std::string many = "a run of 17 pixels; the image has only 16 more";
    EXPECT_EQ(decoded(decode_goo_runs, "").second, "0: no byte 0x55; an image begins with it");
    EXPECT_EQ(decoded(decode_goo_runs, bytes_of({0x55, 3, 0})).second,
              "2: the checksum 0x00; that of the image is 0xfc");
    EXPECT_EQ(decoded(decode_goo_runs, goo_of({0x11, 1})).second, "1: " + many);
    EXPECT_EQ(decoded(decode_goo_runs, goo_of({3, 0x11})).second,
              "2: the end of the image within a run; the image is truncated");
    EXPECT_EQ(decoded(decode_goo_runs, goo_of({0})).second, "1: a run of no pixels; a run has at least one");
    EXPECT_EQ(decoded(decode_ctb_runs, bytes_of({0x80, 17})).second, "0: " + many);
    EXPECT_EQ(decoded(decode_ctb_runs, bytes_of({0x80, 0xF0, 0, 0, 0})).second,
              "0: a length that begins with 0xf0; lengths begin with less than 0xf0");
    EXPECT_EQ(decoded(decode_ctb_runs, bytes_of({5, 0x80, 0x81})).second,
              "1: the end of the image within a run; the image is truncated");
    EXPECT_EQ(decoded(decode_pw0_runs, bytes_of({0x00, 17})).second, "0: " + many);
    EXPECT_EQ(decoded(decode_pw0_runs, bytes_of({0xF0})).second,
              "0: the end of the image within a run; the image is truncated");
    EXPECT_EQ(decoded(decode_bit_runs, bytes_of({17})).second, "0: " + many);
}

TEST(RunCodes, GiveBackWhatTheyEncode) {
    std::mt19937_64 random(4);
    constexpr std::uint32_t width = 97;
    constexpr std::uint32_t height = 53;
    for (int round = 0; round < 60; ++round) {
        std::vector<int> values;
        ByteBuffer goo;
        ByteBuffer ctb;
        ByteBuffer pw0;
        ByteBuffer bits;
        const RunCode black_and_white = bit_runs(128);
        RunEncoder encoders[] = {
            {goo_runs(), goo}, {ctb_runs(), ctb}, {pw0_runs(), pw0}, {black_and_white, bits}};
        for (std::uint32_t row = 0; row < height; ++row) {
            std::vector<PixelRun> runs;
            for (std::uint32_t at = 0; at < width;) {
                at = std::min<std::uint32_t>(
                    width, at + 1 + static_cast<std::uint32_t>(random() % (round % 2 == 0 ? 3 : 200)));
                const auto value =
                    static_cast<std::uint8_t>(random() % 3 == 0 ? random() : 255 * (random() % 2));
                values.resize(row * width + at, value);
                if (!runs.empty() && runs.back().value == value)
                    runs.back().end = at;
                else
                    runs.push_back({at, value});
            }
            for (RunEncoder& encoder : encoders)
                encoder.add(runs, 1);
        }
        for (RunEncoder& encoder : encoders)
            encoder.finish();
        const auto shown = [&](auto of) {
            std::vector<int> all;
            for (const int value : values)
                all.push_back(of(value));
            return std::pair(all, std::string());
        };
        EXPECT_EQ(decoded(decode_goo_runs, goo.view(), width, height), shown([](int v) { return v; }));
        EXPECT_EQ(decoded(decode_ctb_runs, ctb.view(), width, height),
                  shown([](int v) { return v < 2 ? 0 : v | 1; }));
        EXPECT_EQ(decoded(decode_pw0_runs, pw0.view(), width, height),
                  shown([](int v) { return v / 16 * 17; }));
        EXPECT_EQ(decoded(decode_bit_runs, bits.view(), width, height),
                  shown([](int v) { return v >= 128 ? 255 : 0; }));
    }
}

} // namespace
} // namespace lamella::run_codes_cases
