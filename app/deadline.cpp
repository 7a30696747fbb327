#include "deadline.hpp"

#include "crash.hpp"
#include "failure.hpp"
#include "numbers.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>

namespace lamella::app {
namespace {

// While the program waits for standard input, or for a reader of its results, it may never end, so it is
// ended soon. Otherwise it has more time, because releasing gigabytes and a temporary file takes a while.
constexpr std::chrono::milliseconds short_work_budget{700};
constexpr std::chrono::seconds patience{20};
constexpr double longest_seconds = 1e9; // some thirty years, within the range of clocks

} // namespace

Deadline::Deadline(std::optional<double> seconds, std::string what, const Messages& messages,
                   const Execution& execution)
    : seconds_(seconds), what_(std::move(what)), messages_(messages), given_(execution),
      stop_(execution.cancel) {
    if (seconds_)
        watcher_ = std::thread([this] { watch(); });
}

Deadline::~Deadline() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    done_.notify_all();
    if (watcher_.joinable())
        watcher_.join();
}

void Deadline::note_input(std::string what) {
    const std::lock_guard lock(mutex_);
    what_ = std::move(what);
}

void Deadline::note_output(std::string output) {
    const std::lock_guard lock(mutex_);
    output_ = std::move(output);
    reported_ = true;
}

Execution Deadline::execution() {
    if (!seconds_)
        return given_;
    Execution execution = given_;
    execution.progress = [this](const Progress& progress) {
        {
            const std::lock_guard lock(mutex_);
            last_ = progress;
            started_ = true;
        }
        if (given_.progress)
            given_.progress(progress);
    };
    execution.cancel = &stop_;
    return execution;
}

void Deadline::check() const {
    if (!seconds_)
        return;
    // Another process of the same run may have reached its deadline a moment earlier.
    constexpr std::chrono::seconds skew{1};
    std::unique_lock lock(mutex_);
    done_.wait_for(lock, skew, [this] { return expired_ || given_.cancelled(); });
    if (expired_ && !given_.cancelled())
        throw Error(ErrorKind::limit, message());
}

void Deadline::watch() {
    const auto is_ending = [this] {
        return ending_;
    };
    std::unique_lock lock(mutex_);
    const std::chrono::duration<double> time(std::min(*seconds_, longest_seconds));
    if (done_.wait_for(lock, time, is_ending))
        return;
    expired_ = true;
    done_.notify_all();
    lock.unlock(); // a thread that must stop first may report progress
    stop_.request();
    lock.lock();
    const bool reading = !started_ || (last_.stage == Stage::read && last_.done < last_.total);
    if (!done_.wait_for(lock, reading || reported_ ? short_work_budget : patience, is_ending))
        leave_at_once(messages_.last_words(message(), limit_exit_code), limit_exit_code);
}

std::string Deadline::message() const {
    std::string text = fmt::format("{}: stopped after {} s (--timeout)", what_, brief(*seconds_));
    if (reported_)
        return text + " while results were written" +
               (output_.empty() || output_ == "-" ? "" : fmt::format("; {} is complete", output_));
    if (started_) {
        const double part =
            last_.total == 0 ? 1 : static_cast<double>(last_.done) / static_cast<double>(last_.total);
        text +=
            fmt::format(" in the stage {}, of which {:.0f} % was done", stage_name(last_.stage), 100 * part);
    }
    return text + "; nothing was written";
}

} // namespace lamella::app
