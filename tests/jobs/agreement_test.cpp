#include "fixtures/random.hpp"
#include "jobs/agreement.hpp"
#include "thread_processes.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <new>
#include <optional>
#include <span>
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

TEST(Agreement, PassesOnTheWordsSumsAndValuesOfAllProcesses) {
    for (std::size_t processes = 1; processes <= 4; ++processes)
        test::run_processes(processes, [&](Communicator& own) {
            Agreement agreement(own);
            const std::string result = agreement.run([&] {
                std::vector<std::string> words = agreement.gather(std::string(own.process(), 'x'));
                EXPECT_EQ(words.size(), processes);
                std::vector<std::uint64_t> one{1};
                agreement.sum(one);
                EXPECT_EQ(one.front(), processes);
                // From process p to q: p numbers 10 p + q.
                std::vector<std::vector<std::uint64_t>> numbers;
                for (std::size_t to = 0; to < processes; ++to)
                    numbers.emplace_back(own.process(), 10 * own.process() + to);
                const std::vector<std::span<const std::uint64_t>> outgoing(numbers.begin(), numbers.end());
                const auto received = agreement.exchange<std::uint64_t>(outgoing);
                std::vector<std::uint64_t> expected;
                for (std::size_t from = 0; from < processes; ++from)
                    expected.insert(expected.end(), from, 10 * from + own.process());
                EXPECT_EQ(std::vector<std::uint64_t>(received->span().begin(), received->span().end()),
                          expected);
                return words.back();
            });
            EXPECT_EQ(result, std::string(processes - 1, 'x'));
        });
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
            Agreement agreement(own);
            agreement.run([&] {
                if (const std::optional<Error>& failure = failures[own.process()])
                    throw Error(*failure);
                agreement.gather("well");
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
            Agreement agreement(own);
            agreement.run([&] {
                if (own.process() == 2)
                    throw exception;
                agreement.gather({});
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

TEST(Agreement, EndsTheWaitingOfOthersWhereverOneFails) {
    for (int failing_step = 0; failing_step < 4; ++failing_step) {
        const Error error = test::common_failure(3, [&](Communicator& own) {
            Agreement agreement(own);
            agreement.run([&] {
                int step = 0;
                const auto fail_here = [&] {
                    if (own.process() == 1 && step++ == failing_step)
                        throw Error(ErrorKind::input, "this one");
                };
                std::vector<std::uint64_t> numbers(3, 7);
                fail_here();
                agreement.sum(numbers);
                fail_here();
                agreement.gather("words");
                fail_here();
                const std::vector<std::span<const std::uint64_t>> outgoing(3, numbers);
                static_cast<void>(agreement.exchange<std::uint64_t>(outgoing));
                fail_here();
                agreement.gather({});
            });
        });
        EXPECT_EQ(error.kind(), ErrorKind::input);
        EXPECT_STREQ(error.what(), "this one");
    }
}

} // namespace
} // namespace lamella::agreement_cases
