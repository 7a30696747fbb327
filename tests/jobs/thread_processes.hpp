#pragma once

// Processes simulated by threads of one process; only the messages between them are not real.

#include "lamella/core/error.hpp"
#include "lamella/jobs/processes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <thread>
#include <vector>

namespace lamella::test {

/// State shared by the threads. A process that is gone ends the others: waiting for it throws, so that a test
/// fails in cases in which processes would hang.
class ThreadMeeting {
  public:
    /// Contribution of a process to a step that all take.
    struct Post {
        std::string_view step;
        std::string_view said = {};
        std::span<const std::uint64_t> numbers = {};
        std::span<const std::span<const std::byte>> outgoing = {};
    };

    explicit ThreadMeeting(std::size_t processes) : posts_(processes) {}

    [[nodiscard]] std::size_t size() const noexcept { return posts_.size(); }

    /// Calls look(posts of all processes). The posts do not change until all have looked.
    template <class Look>
    void meet(std::size_t process, const Post& post, const Look& look) {
        posts_[process] = post;
        wait();
        for (const Post& other : posts_)
            if (other.step != post.step)
                throw std::logic_error("processes take different steps at a time");
        look(std::span<const Post>(posts_));
        wait();
    }

    void leave() {
        const std::lock_guard lock(mutex_);
        any_gone_ = true;
        changed_.notify_all();
    }

  private:
    void wait() {
        std::unique_lock lock(mutex_);
        const std::uint64_t phase = phase_;
        if (++waiting_ == posts_.size()) {
            waiting_ = 0;
            ++phase_;
            changed_.notify_all();
            return;
        }
        changed_.wait(lock, [&] { return phase_ != phase || any_gone_; });
        if (phase_ == phase)
            throw std::runtime_error("a process is gone that others wait for");
    }

    std::vector<Post> posts_;
    bool any_gone_ = false;
    std::size_t waiting_ = 0;
    std::uint64_t phase_ = 0;
    std::mutex mutex_;
    std::condition_variable changed_;
};

class ThreadProcess final : public Communicator {
  public:
    ThreadProcess(ThreadMeeting& meeting, std::size_t process) : meeting_(meeting), process_(process) {}

    [[nodiscard]] std::size_t process() const noexcept override { return process_; }
    [[nodiscard]] std::size_t size() const noexcept override { return meeting_.size(); }

    void sum(std::span<std::uint64_t> values) override {
        std::vector<std::uint64_t> total(values.size(), 0);
        meeting_.meet(process_, {.step = "sum", .numbers = values},
                      [&](std::span<const ThreadMeeting::Post> all) {
                          for (const ThreadMeeting::Post& other : all)
                              for (std::size_t i = 0; i < total.size(); ++i)
                                  total[i] += other.numbers[i];
                      });
        std::copy(total.begin(), total.end(), values.begin());
    }

    std::vector<std::string> gather(std::string_view mine) override {
        std::vector<std::string> said;
        meeting_.meet(process_, {.step = "gather", .said = mine},
                      [&](std::span<const ThreadMeeting::Post> all) {
                          for (const ThreadMeeting::Post& other : all)
                              said.emplace_back(other.said);
                      });
        return said;
    }

    std::vector<std::uint64_t> exchange(std::span<const std::uint64_t> outgoing) override {
        std::vector<std::uint64_t> incoming;
        meeting_.meet(process_, {.step = "exchange of numbers", .numbers = outgoing},
                      [&](std::span<const ThreadMeeting::Post> all) {
                          for (const ThreadMeeting::Post& from : all)
                              incoming.push_back(from.numbers[process_]);
                      });
        return incoming;
    }

    void exchange(std::span<const std::span<const std::byte>> outgoing,
                  std::span<const std::span<std::byte>> incoming) override {
        meeting_.meet(process_, {.step = "exchange of bytes", .outgoing = outgoing},
                      [&](std::span<const ThreadMeeting::Post> all) {
                          for (std::size_t from = 0; from < size(); ++from) {
                              const std::span<const std::byte> sent = all[from].outgoing[process_];
                              ASSERT_EQ(sent.size(), incoming[from].size());
                              if (!sent.empty())
                                  std::memcpy(incoming[from].data(), sent.data(), sent.size());
                          }
                      });
    }

  private:
    ThreadMeeting& meeting_;
    std::size_t process_;
};

/// Runs body(communicator) as this many processes and returns the error of each. An exception that is no
/// Error counts as internal.
template <class Body>
std::vector<std::optional<Error>> failures_of(std::size_t processes, const Body& body) {
    ThreadMeeting meeting(processes);
    std::vector<std::optional<Error>> failures(processes);
    std::vector<std::thread> threads;
    for (std::size_t p = 0; p < processes; ++p)
        threads.emplace_back([&, p] {
            ThreadProcess own(meeting, p);
            try {
                body(own);
            } catch (const Error& error) {
                failures[p] = error;
            } catch (const std::exception& error) {
                failures[p] = Error(ErrorKind::internal, error.what());
            }
            meeting.leave();
        });
    for (std::thread& thread : threads)
        thread.join();
    return failures;
}

/// Runs body(communicator) as this many processes; none of them may fail.
template <class Body>
void run_processes(std::size_t processes, const Body& body) {
    for (const std::optional<Error>& failure : failures_of(processes, body))
        EXPECT_FALSE(failure.has_value()) << failure->what();
}

/// Returns the results of a job sliced by this many processes.
inline std::vector<FileResult> slice_by(std::size_t processes, const FileJob& job) {
    std::vector<FileResult> results(processes);
    run_processes(processes,
                  [&](Communicator& own) { results[own.process()] = slice_file(job, {.threads = 2}, own); });
    return results;
}

/// Runs body(communicator) as this many processes; all of them must fail, with the same error.
template <class Body>
Error common_failure(std::size_t processes, const Body& body) {
    const std::vector<std::optional<Error>> failures = failures_of(processes, body);
    Error common(ErrorKind::internal, "none failed");
    for (std::size_t p = 0; p < processes; ++p) {
        EXPECT_TRUE(failures[p].has_value()) << "process " << p << " did not fail";
        if (p == 0 && failures[p])
            common = *failures[p];
        if (failures[p]) {
            EXPECT_EQ(failures[p]->kind(), common.kind()) << failures[p]->what();
            EXPECT_STREQ(failures[p]->what(), common.what());
        }
    }
    return common;
}

} // namespace lamella::test
