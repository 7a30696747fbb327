#pragma once

// The time limit of a computation (--timeout).

#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"

#include "messages.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace lamella::app {

/// Stops a computation when its time is up. If the program does not stop, for example because it waits for
/// standard input, it is ended a short while later with exit code 5.
class Deadline {
  public:
    /// Without `seconds` there is no limit. `what` is the beginning of the message: the file that is being
    /// processed.
    Deadline(std::optional<double> seconds, std::string what, const Messages& messages,
             const Execution& execution);
    ~Deadline();
    Deadline(const Deadline&) = delete;
    Deadline& operator=(const Deadline&) = delete;

    /// Returns the result of `work(execution)` with an execution that the caller's flag or the deadline
    /// cancels. If the deadline does, throws Error{limit} that reports how far the computation had come.
    template <class Work>
    auto run(const Work& work) {
        try {
            return work(execution());
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled)
                check();
            throw;
        }
    }

    /// Replaces the file that is being processed.
    void note_input(std::string what);
    /// Must be called when the output is complete and only reporting remains. If the time is up before that
    /// ends, the program is ended as if it were stuck.
    void note_output(std::string output);

  private:
    [[nodiscard]] Execution execution();
    void check() const;
    void watch();
    [[nodiscard]] std::string message() const;

    std::optional<double> seconds_;
    std::string what_;
    const Messages& messages_;
    const Execution& given_;
    CancelFlag stop_;
    mutable std::mutex mutex_;
    mutable std::condition_variable done_; ///< notified when done or expired
    Progress last_;
    bool started_ = false;  ///< true if `last_` is valid
    bool reported_ = false; ///< true if only reporting remains
    std::string output_;    ///< the complete output; "" or "-" if it is not a file
    bool ending_ = false;
    bool expired_ = false;
    std::thread watcher_;
};

} // namespace lamella::app
