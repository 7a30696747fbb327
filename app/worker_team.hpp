#pragma once

// Processes that work on the tasks of a batch, so that a task which crashes takes nobody along.

#include "lamella/core/execution.hpp"

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella::app {

/// What a worker is asked for: the numbers mean to its work what they will.
struct WorkerTask {
    std::size_t first = 0;
    std::size_t count = 1;
    unsigned threads = 1;
};

/// What became of a task.
struct WorkerAnswer {
    WorkerTask task;
    std::optional<std::string> text; ///< what the work returned; unset where the process ended before
    int status = 0;                  ///< of that end, as waitpid tells it
    bool begun = true;               ///< false where it ended before it was a worker: others may do the task
};

/// Worker processes: copies of this process by fork, each of which does one task at a time, one after the
/// other. A worker is started when the first task needs it, and again for a later task where it has died;
/// so a task costs two messages, not a process.
///
/// Workers stop when they are told to, and when this process dies, for whatever reason. The signals that its
/// Interrupt waits for are kept from them, too: a terminal sends these to all processes at once, and a worker
/// that was told twice would leave without an answer. For one thread; its process may have others that wait.
class WorkerTeam {
  public:
    /// Runs in a worker. Must not throw. The flag tells that the worker shall stop. Of what it returns no
    /// more than `longest_answer` bytes arrive.
    using Work = std::function<std::string(const WorkerTask&, const CancelFlag&)>;
    static constexpr std::size_t longest_answer = std::size_t{1} << 16; ///< far below what a socket takes

    WorkerTeam(std::size_t size, Work work);
    /// Ends the workers; those in the midst of a task are told to stop and waited for.
    ~WorkerTeam();
    WorkerTeam(const WorkerTeam&) = delete;
    WorkerTeam& operator=(const WorkerTeam&) = delete;

    /// Hands a task to a worker that has none: fewer tasks than workers must be under way. Throws
    /// Error{limit} when none waits for one, and the system gives no further process.
    void start(const WorkerTask& task);

    /// Tells workers that have a task to stop soon; they answer as ever.
    void stop() noexcept;
    [[nodiscard]] bool is_busy() const noexcept;

    /// Waits for answers; after a moment without any, returns none. Throws Error{limit} when no process that
    /// was started could become a worker.
    [[nodiscard]] std::vector<WorkerAnswer> wait();

  private:
    struct Worker {
        pid_t process = -1;
        int socket = -1;
        std::optional<WorkerTask> task;
    };

    void launch(Worker& worker);
    [[noreturn]] void serve(int socket) const;
    [[nodiscard]] WorkerAnswer answer_of(Worker& worker);

    Work work_;
    std::vector<Worker> workers_;
};

} // namespace lamella::app
