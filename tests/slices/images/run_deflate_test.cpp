#include "fixtures/random.hpp"
#include "slices/images/run_deflate.hpp"

#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace lamella {
namespace {

using test::Random;

struct Piece {
    std::uint8_t value;
    std::uint64_t count;
};

std::string bytes_of(const std::vector<Piece>& runs) {
    std::string bytes;
    for (const Piece& run : runs)
        bytes.append(run.count, static_cast<char>(run.value));
    return bytes;
}

std::string deflated(RunDeflater& deflater, const std::vector<Piece>& runs) {
    for (const Piece& run : runs)
        deflater.put(run.value, run.count);
    return std::string(deflater.finish());
}

/// What zlib makes of a stream, which must have no byte too many; checks the checksum.
std::string inflated(const std::string& stream, std::size_t size) {
    std::string bytes(size + 1, '?');
    z_stream z{};
    EXPECT_EQ(inflateInit(&z), Z_OK);
    z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stream.data()));
    z.avail_in = static_cast<uInt>(stream.size());
    z.next_out = reinterpret_cast<Bytef*>(bytes.data());
    z.avail_out = static_cast<uInt>(bytes.size());
    EXPECT_EQ(inflate(&z, Z_FINISH), Z_STREAM_END) << (z.msg == nullptr ? "" : z.msg);
    EXPECT_EQ(z.avail_in, 0U);
    bytes.resize(z.total_out);
    inflateEnd(&z);
    return bytes;
}

void expect_round_trip(const std::vector<Piece>& runs) {
    RunDeflater deflater;
    const std::string bytes = bytes_of(runs);
    const std::string back = inflated(deflated(deflater, runs), bytes.size());
    ASSERT_TRUE(back == bytes) << bytes.size() << " bytes in " << runs.size() << " runs";
}

TEST(RunDeflater, GivesBackRunsOfEveryLength) {
    for (std::uint64_t count = 0; count < 1200; ++count) {
        expect_round_trip({{7, count}});
        expect_round_trip({{255, 1}, {0, count}, {3, 2}});
    }
}

TEST(RunDeflater, GivesBackAnyRuns) {
    Random random(1);
    for (int round = 0; round < 300; ++round) {
        std::vector<Piece> runs;
        const auto count = random.integer(0, 3000);
        const auto values = random.integer(1, 256);
        const auto longest = random.integer(1, 700);
        for (std::int64_t i = 0; i < count; ++i)
            runs.push_back({static_cast<std::uint8_t>(random.integer(0, values - 1)),
                            static_cast<std::uint64_t>(random.integer(0, longest))});
        expect_round_trip(runs);
    }
}

TEST(RunDeflater, GivesBackManyBlocks) {
    Random random(2);
    std::vector<Piece> runs;
    for (int i = 0; i < 300000; ++i)
        runs.push_back({static_cast<std::uint8_t>(random.bits()), static_cast<std::uint64_t>(1 + i % 5)});
    expect_round_trip(runs);
}

TEST(RunDeflater, LimitsItsCodesWhateverTheFrequencies) {
    // Fibonacci's numbers as frequencies make the deepest tree: 20 literals and one copy, all in one block.
    std::vector<Piece> runs;
    std::uint64_t count = 1;
    std::uint64_t next = 1;
    for (std::uint8_t value = 0; value < 20; ++value) {
        for (std::uint64_t i = 0; i < count; ++i) {
            runs.push_back({value, 1});
            runs.push_back({200, 1});
        }
        count = std::exchange(next, count + next);
    }
    runs.push_back({200, 100000});
    runs.resize(std::min<std::size_t>(runs.size(), 32000));
    expect_round_trip(runs);
    // Powers of two, by the lengths of runs.
    runs.clear();
    for (std::uint8_t value = 0; value < 27; ++value)
        for (std::uint64_t i = 0; i < std::uint64_t{1} << (value / 2); ++i)
            runs.push_back({value, 3});
    expect_round_trip(runs);
}

TEST(RunDeflater, ChecksRunsBeyondTheModulusOfItsChecksum) {
    for (const std::uint64_t count : {65520U, 65521U, 65522U, 131041U, 131042U, 131043U, 1000003U, 33554432U})
        expect_round_trip({{1, 3}, {255, count}, {254, count / 3}, {0, 1}});
}

TEST(RunDeflater, DependsOnBytesOnlyAndStartsAfreshEachTime) {
    RunDeflater deflater;
    const std::string whole = deflated(deflater, {{0, 900}, {9, 2}, {0, 40}});
    EXPECT_EQ(deflated(deflater, {{0, 300}, {0, 600}, {4, 0}, {9, 1}, {9, 1}, {0, 40}}), whole);
    EXPECT_EQ(inflated(deflated(deflater, {}), 0), "");
    EXPECT_EQ(deflated(deflater, {{0, 900}, {9, 2}, {0, 40}}), whole);
}

TEST(RunDeflater, TakesRowsAsTheirRuns) {
    Random random(7);
    RunDeflater by_rows;
    RunDeflater by_runs;
    for (int i = 0; i < 3000; ++i) { // some blocks of them
        std::vector<PixelRun> row;
        std::uint32_t end = 0;
        for (std::int64_t k = random.integer(1, 40); k > 0; --k) {
            end += static_cast<std::uint32_t>(random.integer(1, k % 3 == 0 ? 900 : 4));
            const auto step = static_cast<std::uint8_t>(random.integer(1, 255));
            const std::uint8_t before = row.empty() ? std::uint8_t{0} : row.back().value;
            row.push_back({end, static_cast<std::uint8_t>(before + step)});
        }
        by_rows.put(row);
        std::uint32_t from = 0;
        for (const PixelRun& run : row) {
            by_runs.put(run.value, run.end - from);
            from = run.end;
        }
    }
    EXPECT_TRUE(by_rows.finish() == by_runs.finish());
}

TEST(RunDeflater, NeedsTwoBitsForTheLongestCopies) {
    RunDeflater deflater;
    EXPECT_LT(deflated(deflater, {{0, 258 * 40000}}).size(), 2 * 40000 / 8 + 50U);
}

} // namespace
} // namespace lamella
