#include "fixtures/random.hpp"
#include "pipeline/agreement.hpp"
#include "thread_processes.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <new>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace lamella::agreement_cases {
namespace {

/// What is heard of these failures, one for each process that failed.
std::optional<Error> heard_of(const std::vector<std::optional<Error>>& failures) {
    std::optional<Error> cancelled;
    for (const std::optional<Error>& failure : failures) {
        if (!failure)
            continue;
        if (failure->kind() != ErrorKind::cancelled)
            return failure;
        if (!cancelled)
            cancelled = failure;
    }
    return cancelled;
}

TEST(Agreement, WaitsUntilTheStepIsDoneOnAllProcesses) {
    for (std::size_t processes = 1; processes <= 4; ++processes) {
        std::atomic<std::size_t> done{0};
        test::run_processes(processes, [&](Communicator& own) {
            in_agreement(own, [&] { ++done; });
            EXPECT_EQ(done, processes);
        });
    }
}

TEST(Agreement, HasAllThrowWhatTheFirstThrewAndRatherNotThatItWasCancelled) {
    test::Random random(7);
    for (int round = 0; round < 200; ++round) {
        SCOPED_TRACE(testing::Message() << "round " << round);
        const auto processes = static_cast<std::size_t>(random.integer(2, 5));
        std::vector<std::optional<Error>> failures(processes);
        for (std::size_t p = 0; p < processes; ++p)
            if (random.integer(0, 2) != 0) {
                const auto kind = random.integer(0, 1) == 0 ? ErrorKind::cancelled
                                                            : static_cast<ErrorKind>(random.integer(0, 6));
                failures[p].emplace(kind, "failed on process " + std::to_string(p));
            }
        const std::optional<Error> heard = heard_of(failures);
        const auto step = [&](Communicator& own) {
            in_agreement(own, [&] {
                if (const std::optional<Error>& failure = failures[own.process()])
                    throw Error(*failure);
            });
        };
        if (heard) {
            const Error common = test::common_failure(processes, step);
            EXPECT_EQ(common.kind(), heard->kind());
            EXPECT_STREQ(common.what(), heard->what());
        } else {
            test::run_processes(processes, step);
        }
    }
}

TEST(Agreement, ReportsOtherExceptionsInTheWordsOfAnError) {
    const auto failing_with = [](const auto& exception) {
        return test::common_failure(3, [&](Communicator& own) {
            in_agreement(own, [&] {
                if (own.process() == 2)
                    throw exception;
            });
        });
    };
    const Error memory = failing_with(std::bad_alloc());
    EXPECT_EQ(memory.kind(), ErrorKind::limit);
    EXPECT_STREQ(memory.what(), "memory ran out on one of the processes; use more of them");
    const Error other = failing_with(std::out_of_range("no such row"));
    EXPECT_EQ(other.kind(), ErrorKind::internal);
    EXPECT_STREQ(other.what(), "no such row");
}

TEST(Agreement, LeavesProcessesAtTheSamePlaceAfterAFailure) {
    test::run_processes(4, [](Communicator& own) {
        for (std::size_t failing = 0; failing < own.size(); ++failing)
            EXPECT_THROW(in_agreement(own,
                                      [&] {
                                          if (own.process() == failing)
                                              throw Error(ErrorKind::input, "this one");
                                      }),
                         Error);
        std::vector<std::uint64_t> one{1};
        own.sum(one);
        EXPECT_EQ(one.front(), own.size());
    });
}

TEST(Agreement, OfAProcessAlonePassesWhateverIsThrownUnchanged) {
    EXPECT_THROW(in_agreement(alone(), [] { throw std::out_of_range("no such row"); }), std::out_of_range);
}

} // namespace
} // namespace lamella::agreement_cases
