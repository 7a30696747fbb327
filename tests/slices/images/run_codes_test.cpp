#include "slices/images/run_codes.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <string>
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

} // namespace
} // namespace lamella::run_codes_cases
