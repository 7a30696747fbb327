#include "core/executor.hpp"
#include "fixtures/expect_error.hpp"
#include "fixtures/rounds.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <fstream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace lamella {
namespace {

TEST(Executor, UsesAsManyWorkersAsAskedForAndAtLeastOne) {
    EXPECT_EQ(Executor({.threads = 5}).workers(), 5U);
    EXPECT_GE(Executor({}).workers(), 1U);
}

TEST(Executor, RefusesMoreThreadsThanAnySystemStarts) {
    EXPECT_EQ(Executor(Execution{.threads = most_threads}).workers(), most_threads); // none is started yet
    EXPECT_THROW(Executor(Execution{.threads = most_threads + 1}), Error);
}

TEST(Executor, RunsTheBodyOnceForEachWorker) {
    Executor executor({.threads = 4});
    for (int region = 0; region < 50; ++region) {
        std::vector<std::atomic<int>> calls(4);
        executor.run([&](unsigned worker) { ++calls[worker]; });
        for (const auto& count : calls)
            EXPECT_EQ(count, 1);
    }
}

TEST(Executor, ChunksCoverTheRangeExactlyOnce) {
    for (const unsigned threads : {1U, 2U, 7U}) {
        Executor executor({.threads = threads});
        for (const std::uint64_t n : {0U, 1U, 9U, 10U, 11U, 1000U}) {
            std::vector<std::atomic<int>> seen(n);
            executor.for_chunks(n, 10, [&](std::uint64_t begin, std::uint64_t end, unsigned worker) {
                EXPECT_LT(worker, threads);
                EXPECT_LE(end - begin, 10U);
                for (std::uint64_t i = begin; i < end; ++i)
                    ++seen[i];
            });
            for (const auto& count : seen)
                EXPECT_EQ(count, 1);
        }
    }
}

TEST(Executor, RunsOnThreadsOfTheCaller) {
    std::set<std::thread::id> ids;
    int regions = 0;
    const auto backwards = [&](unsigned tasks, const std::function<void(unsigned)>& task) {
        ++regions;
        for (unsigned i = tasks; i > 0; --i)
            task(i - 1);
    };
    Executor executor({.threads = 3, .run_tasks = backwards});
    std::vector<int> seen(100);
    executor.for_chunks(seen.size(), 1, [&](std::uint64_t begin, std::uint64_t, unsigned) {
        ++seen[begin];
        ids.insert(std::this_thread::get_id());
    });
    EXPECT_EQ(seen, std::vector<int>(seen.size(), 1));
    EXPECT_EQ(ids, std::set<std::thread::id>{std::this_thread::get_id()});
    EXPECT_EQ(regions, 1);
    const auto fail_in_one = [](unsigned worker) {
        if (worker == 1)
            throw std::out_of_range("");
    };
    EXPECT_THROW(executor.run(fail_in_one), std::out_of_range);
}

TEST(Executor, NoticesThatTasksWereLeftOut) {
    const auto first_only = [](unsigned, const std::function<void(unsigned)>& task) {
        task(0);
    };
    Executor executor({.threads = 3, .run_tasks = first_only});
    test::expect_error(ErrorKind::usage, {"run_tasks of an Execution ran 1 of 3 tasks"},
                       [&] { executor.run([](unsigned) {}); });
}

TEST(Executor, ReportsTheErrorOfATaskAlthoughThePoolSkipsTheOthers) {
    const auto until_an_error = [](unsigned, const std::function<void(unsigned)>& task) {
        task(0);
    };
    Executor executor({.threads = 3, .run_tasks = until_an_error});
    for (int round = 0; round < 2; ++round)
        EXPECT_THROW(executor.run([](unsigned) { throw std::out_of_range(""); }), std::out_of_range);
    test::expect_error(ErrorKind::usage, {"ran 1 of 3 tasks"}, [&] { executor.run([](unsigned) {}); });
}

TEST(Executor, ARangeOfOneChunkStaysOnTheCallingThread) {
    Executor executor({.threads = 3});
    const auto caller = std::this_thread::get_id();
    executor.for_chunks(10, 10, [&](std::uint64_t, std::uint64_t, unsigned worker) {
        EXPECT_EQ(worker, 0U);
        EXPECT_EQ(std::this_thread::get_id(), caller);
    });
}

TEST(Executor, AnExceptionReachesTheCallerAndTheTeamLivesOn) {
    for (const unsigned threads : {1U, 3U}) {
        Executor executor({.threads = threads});
        EXPECT_THROW(executor.for_chunks(1000, 1,
                                         [](std::uint64_t begin, std::uint64_t, unsigned) {
                                             if (begin == 17)
                                                 throw std::runtime_error("seventeen");
                                         }),
                     std::runtime_error);
        std::atomic<int> done = 0;
        executor.for_chunks(100, 1, [&](std::uint64_t, std::uint64_t, unsigned) { ++done; });
        EXPECT_EQ(done, 100);
    }
}

TEST(Executor, StopsAtTheNextChunkWhenAsked) {
    for (const unsigned threads : {1U, 3U}) {
        CancelFlag stop;
        Executor executor({.threads = threads, .cancel = &stop});
        std::atomic<int> chunks = 0;
        test::error_of(ErrorKind::cancelled, [&] {
            executor.for_chunks(100000, 1, [&](std::uint64_t, std::uint64_t, unsigned) {
                if (++chunks == 10)
                    stop.request();
            });
        });
        EXPECT_LT(chunks, 100);
    }
}

TEST(ProgressMeter, NeverFallsAndEndsAtTheTotal) {
    std::vector<std::uint64_t> reports;
    const Execution execution{.threads = 3, .progress = [&](const Progress& p) {
                                  EXPECT_EQ(p.stage, Stage::link);
                                  EXPECT_EQ(p.total, 10000U);
                                  reports.push_back(p.done);
                              }};
    ProgressMeter meter(execution, Stage::link, 10000);
    Executor executor(execution);
    executor.for_chunks(10000, 7,
                        [&](std::uint64_t begin, std::uint64_t end, unsigned) { meter.add(end - begin); });
    meter.finish();
    ASSERT_FALSE(reports.empty());
    EXPECT_TRUE(std::is_sorted(reports.begin(), reports.end()));
    EXPECT_EQ(reports.front(), 0U);
    EXPECT_EQ(reports.back(), 10000U);
    EXPECT_GE(reports.size(), 10U);
    EXPECT_LE(reports.size(), 102U);
}

TEST(ProgressMeter, WhatTheProgressFunctionThrowsReachesTheCaller) {
    const Execution execution{.threads = 2, .progress = [](const Progress& p) {
                                  if (p.done > 500)
                                      throw std::runtime_error("enough");
                              }};
    ProgressMeter meter(execution, Stage::read, 1000);
    Executor executor(execution);
    EXPECT_THROW(
        executor.for_chunks(
            1000, 10, [&](std::uint64_t begin, std::uint64_t end, unsigned) { meter.add(end - begin); }),
        std::runtime_error);
}

TEST(Stage, HasADistinctNameForEachStage) {
    std::set<std::string> names;
    for (const Stage stage :
         {Stage::read, Stage::weld, Stage::link, Stage::slice, Stage::polygon, Stage::write})
        names.insert(stage_name(stage));
    EXPECT_EQ(names.size(), 6U);
    EXPECT_FALSE(names.contains("?"));
}

TEST(CancelFlag, HearsARequestToTheFlagAroundItButNotTheOtherWay) {
    CancelFlag outer;
    CancelFlag inner(&outer);
    CancelFlag other(&outer);
    inner.request();
    EXPECT_TRUE(inner.requested());
    EXPECT_FALSE(outer.requested());
    EXPECT_FALSE(other.requested());
    outer.request();
    EXPECT_TRUE(other.requested());
}

} // namespace
} // namespace lamella
