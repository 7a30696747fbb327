#include "slicing/sweep/crew.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella::crew_cases {
namespace {

Run run_of(std::uint32_t begin, std::uint32_t end) {
    return {begin, end, 1, true, 0, 0, ColumnStore::not_kept};
}

TEST(Crew, DoesEachRunOnEachOfThePlanesOnce) {
    for (const unsigned threads : {1U, 3U}) {
        for (const bool shared : {false, true}) {
            Executor executor({.threads = threads});
            Crew crew(executor, shared);
            for (const std::size_t count : {0U, 1U, 2U, 500U}) {
                std::vector<lamella::Run> runs;
                for (std::uint32_t i = 0; i < count; ++i)
                    runs.push_back(run_of(i % 7, 8 + i % 11));
                std::vector<std::vector<std::atomic<int>>> times;
                for (std::size_t i = 0; i < count; ++i)
                    times.emplace_back(20);
                crew.for_runs(runs, {3, 12}, [&](const lamella::Run& run, PlaneRange part, Scratch&) {
                    EXPECT_NE(part.size(), 0U);
                    for (std::uint32_t p = part.begin; p < part.end; ++p)
                        ++times[static_cast<std::size_t>(&run - runs.data())][p];
                });
                for (std::size_t i = 0; i < count; ++i)
                    for (std::uint32_t p = 0; p < 20; ++p)
                        EXPECT_EQ(times[i][p],
                                  p >= 3 && p < 12 && p >= runs[i].begin && p < runs[i].end ? 1 : 0);
            }
        }
    }
}

TEST(Crew, DoesEachOfManyThingsOnce) {
    for (const bool shared : {false, true}) {
        Executor executor({.threads = 3});
        Crew crew(executor, shared);
        std::vector<std::atomic<int>> times(100);
        crew.for_each(times.size(), [&](std::uint64_t i, Scratch&) { ++times[i]; });
        for (const std::atomic<int>& count : times)
            EXPECT_EQ(count, 1);
    }
}

} // namespace
} // namespace lamella::crew_cases
