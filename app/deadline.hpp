#pragma once

// --timeout: a time limit of a computation.

#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"

#include "messages.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace lamella::app {

/// Stops a computation when its time is up. If the program is stuck then (for example waiting for standard
/// input), it is ended a short while later with exit code 5.
class Deadline {
  public:
    /// Without `seconds` there is no limit. `what` is the beginning of the message: the file that is being
    /// processed.
    Deadline(std::optional<double> seconds, std::string what, const Messages& messages,
             const Execution& execution);
    ~Deadline();
    Deadline(const Deadline&) = delete;
    Deadline& operator=(const Deadline&) = delete;

    /// Returns `work(execution)`, with the given execution, which it or the deadline stops. If the deadline
    /// did, Error{limit} describes how far the computation had come.
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

    /// Notes that the output is complete: only reporting remains. If the time is up before that is done, the
    /// program is ended as if it were stuck.
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
    bool started_ = false;  ///< `last_` is valid
    bool reported_ = false; ///< only reporting remains
    std::string output_;    ///< the complete output; "" or "-" if it is not a file
    bool ending_ = false;
    bool expired_ = false;
    std::thread watcher_;
};

} // namespace lamella::app
