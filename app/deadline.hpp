#pragma once

// --timeout: an end to a computation that takes too long.

#include "lamella/core/error.hpp"
#include "lamella/core/execution.hpp"

#include "messages.hpp"

#include <condition_variable>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

namespace lamella::app {

/// Stops a computation when its time is up. Should it be stuck then (such as waiting for standard input), the
/// program is ended a short while after with exit code 5.
class Deadline {
  public:
    /// Without `seconds` there is no end. `what` stands at the begin of the message: the file that is worked
    /// on.
    Deadline(std::optional<double> seconds, std::string what, const Messages& messages,
             const Execution& execution);
    ~Deadline();
    Deadline(const Deadline&) = delete;
    Deadline& operator=(const Deadline&) = delete;

    /// What `work(execution)` returns, with the execution given, stopped by it or by the deadline. Where that
    /// was the deadline, Error{limit} says how far the computation came.
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

    /// The output has its name: what is still to come is to tell of it. Where the time is up before that is
    /// done, the program is ended as if it were stuck.
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
    mutable std::condition_variable done_; ///< or expired
    Progress last_;
    bool started_ = false; ///< `last_` is a report
    bool told_ = false;    ///< only telling is left
    std::string output_;   ///< then; "" or "-" where it is no file
    bool ending_ = false;
    bool expired_ = false;
    std::thread watcher_;
};

} // namespace lamella::app
