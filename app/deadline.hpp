#pragma once

// --timeout: an end to a computation that takes too long.

#include "lamella/core/execution.hpp"

#include "messages.hpp"

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

namespace lamella::app {

/// Stops a computation when its time is up. Should it be stuck then (such as waiting for standard input), the
/// program is ended a short while after with exit code 5.
class Deadline {
  public:
    /// `what` stands at the begin of the message: the file that is worked on.
    Deadline(double seconds, std::string what, const Messages& messages, const Execution& execution);
    ~Deadline();
    Deadline(const Deadline&) = delete;
    Deadline& operator=(const Deadline&) = delete;

    /// The execution given, stopped by it or by the deadline. Not to be used after the deadline is gone.
    [[nodiscard]] Execution execution();

    /// Throws Error{limit} that says how far the computation came, if it was the deadline that stopped it.
    void check() const;

  private:
    void watch();
    [[nodiscard]] std::string message() const;

    double seconds_;
    std::string what_;
    const Messages& messages_;
    const Execution& given_;
    CancelFlag stop_;
    mutable std::mutex mutex_;
    mutable std::condition_variable done_; ///< or expired
    Progress last_;
    bool started_ = false; ///< `last_` is a report
    bool ending_ = false;
    bool expired_ = false;
    std::thread watcher_;
};

} // namespace lamella::app
