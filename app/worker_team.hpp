#pragma once

// Processes that work on the tasks of a batch, so that a crash affects its own task only.

#include "lamella/core/execution.hpp"

#include "system/program_workers.hpp"

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella::app {

/// A request to a worker, whose work interprets the numbers.
struct WorkerTask {
    std::size_t first = 0;
    std::size_t count = 1;
    unsigned threads = 1;
};

struct WorkerAnswer {
    WorkerTask task;
    std::optional<std::string> text; ///< result of the work; unset if the process ended before
    ProcessEnd end;                  ///< how the process ended
    bool begun = true; ///< false if the process ended before it could work; others may do the task
};

/// Worker processes, each of which does one task after the other. A worker is started when a task needs it,
/// and restarted for a later task if it has died. So a task costs two messages, not a process.
///
/// Workers are forks of this process where the system has them. Elsewhere they are this program, started
/// again with the same arguments, and `introduction` is what they get to know from this process: they must
/// call `introduction_to_worker`, and then make the same team, which serves its owner and ends the process.
///
/// Workers stop on request, and when this process dies for any reason. They do not receive the signals that
/// Interrupt handles, because a terminal sends these to all processes at once, and a worker that is stopped
/// twice ends without an answer. To be used by one thread; other threads of its process must only wait.
class WorkerTeam {
  public:
    /// The work, which runs in a worker. Must not throw. A request on the flag means that it should stop. The
    /// result is truncated to `longest_answer` bytes.
    using Work = std::function<std::string(const WorkerTask&, const CancelFlag&)>;
    static constexpr std::size_t longest_answer = std::size_t{1} << 16;

    WorkerTeam(std::size_t size, Work work, std::string introduction);
    /// Ends the workers; busy ones are asked to stop and waited for.
    ~WorkerTeam();
    WorkerTeam(const WorkerTeam&) = delete;
    WorkerTeam& operator=(const WorkerTeam&) = delete;

    /// Passes a task to an idle worker. Requires that fewer tasks are in progress than there are workers.
    /// Throws Error{limit} if no started worker is idle and no further process can be started.
    void start(const WorkerTask& task);

    /// Asks busy workers to stop soon; they still answer.
    void stop() noexcept;
    [[nodiscard]] bool is_busy() const noexcept;

    /// Waits for answers. Returns an empty list if none arrives for a moment. Throws Error{limit} if no
    /// process could be started as a worker.
    [[nodiscard]] std::vector<WorkerAnswer> wait();

  private:
    void launch(std::size_t worker);
    [[nodiscard]] int serve(const WorkerChannel& channel) const;
    [[nodiscard]] WorkerAnswer answer_of(std::size_t worker);

    Work work_;
    std::string introduction_;
    std::vector<WorkerProcess> processes_;
    std::vector<std::optional<WorkerTask>> tasks_; ///< of each process
};

/// In a process that was started as a worker of a WorkerTeam, returns the introduction of its owner; none
/// elsewhere.
[[nodiscard]] std::optional<std::string> introduction_to_worker();

} // namespace lamella::app
