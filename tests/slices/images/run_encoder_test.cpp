#include "slices/images/run_codes.hpp"
#include "slices/images/run_encoder.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace lamella::run_encoder_cases {
namespace {

using Runs = std::vector<std::pair<unsigned, std::uint64_t>>;

/// A code that records its runs as text.
RunCode recording(unsigned shift) {
    RunCode code;
    for (unsigned v = 0; v < 256; ++v)
        code.joined[v] = static_cast<std::uint8_t>(v >> shift);
    code.put = [](std::uint8_t value, std::uint64_t pixels, ByteBuffer& out) {
        out.append(std::to_string(value) + "x" + std::to_string(pixels) + " ");
    };
    return code;
}

std::string text_of(const Runs& runs) {
    std::string text;
    for (const auto& [value, pixels] : runs)
        text += std::to_string(value) + "x" + std::to_string(pixels) + " ";
    return text;
}

TEST(RunEncoder, JoinsRunsAcrossRows) {
    const RunCode code = recording(0);
    ByteBuffer out;
    out.append("before ");
    RunEncoder encoder(code, out);
    encoder.add(std::vector<PixelRun>{{8, 0}}, 3);
    encoder.add(std::vector<PixelRun>{{2, 0}, {8, 9}}, 1);
    encoder.add(std::vector<PixelRun>{{5, 9}, {8, 7}}, 2);
    encoder.add(std::vector<PixelRun>{{8, 7}}, 1);
    encoder.finish();
    EXPECT_EQ(out.view(), "before " + text_of({{0, 26}, {9, 11}, {7, 3}, {9, 5}, {7, 11}}));
    EXPECT_EQ(encoder.lit(), 30U);
}

TEST(RunEncoder, JoinsValuesThatTheCodeTakesForOne) {
    const RunCode code = recording(4);
    ByteBuffer out;
    RunEncoder encoder(code, out);
    encoder.add(std::vector<PixelRun>{{2, 15}, {3, 16}, {4, 31}}, 2);
    encoder.finish();
    EXPECT_EQ(out.view(), text_of({{0, 2}, {1, 2}, {0, 2}, {1, 2}}));
    EXPECT_EQ(encoder.lit(), 4U);
}

TEST(RunEncoder, HasTheLongestRunsOfAnyImage) {
    std::mt19937 random(1);
    const auto below = [&](std::uint32_t n) {
        return static_cast<std::uint32_t>(random() % n);
    };
    for (int round = 0; round < 200; ++round) {
        const std::uint32_t width = 1 + below(20);
        const RunCode code = recording(0);
        ByteBuffer out;
        RunEncoder encoder(code, out);
        Runs expected;
        for (std::uint32_t r = 1 + below(6); r > 0; --r) {
            std::vector<PixelRun> row;
            for (std::uint32_t c = 0; c < width; ++c) {
                const auto value = static_cast<std::uint8_t>(below(3));
                if (row.empty() || row.back().value != value)
                    row.push_back({c + 1, value});
                row.back().end = c + 1;
            }
            const std::uint32_t times = 1 + below(3);
            encoder.add(row, times);
            for (std::uint32_t i = 0; i < times; ++i) {
                std::uint32_t from = 0;
                for (const PixelRun& run : row) {
                    if (expected.empty() || expected.back().first != run.value)
                        expected.emplace_back(run.value, 0);
                    expected.back().second += run.end - from;
                    from = run.end;
                }
            }
        }
        encoder.finish();
        EXPECT_EQ(out.view(), text_of(expected));
    }
}

} // namespace
} // namespace lamella::run_encoder_cases
