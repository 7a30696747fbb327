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

/// What a worker is asked for: both numbers mean to its work what they will.
struct WorkerTask {
    std::size_t index = 0;
    unsigned threads = 1;
};

/// What became of a task.
struct WorkerAnswer {
    std::size_t index = 0;
    std::optional<std::string> text; ///< what the work returned; unset where the process ended before
    int status = 0;                  ///< of that end, as waitpid tells it
};

/// Worker processes: copies of this process by fork, each of which does one task at a time, one after the
/// other. A worker is started when the first task needs it, and again for a later task where it has died;
/// so a task costs two messages, not a process.
///
/// Workers stop at SIGINT, SIGTERM and SIGHUP as a program of its own does, and when this process dies,
/// whatever of. For one thread; its process may have others that wait.
class WorkerTeam {
  public:
    /// Runs in a worker. Must not throw. The flag tells that the worker shall stop.
    using Work = std::function<std::string(const WorkerTask&, const CancelFlag&)>;

    WorkerTeam(std::size_t size, Work work);
    /// Ends the workers; those in the midst of a task are told to stop and waited for.
    ~WorkerTeam();
    WorkerTeam(const WorkerTeam&) = delete;
    WorkerTeam& operator=(const WorkerTeam&) = delete;

    /// Hands a task to a worker that has none: fewer tasks than workers must be under way. Throws
    /// Error{limit} when the system gives no process for it.
    void start(const WorkerTask& task);

    /// Waits for answers; after a moment without any, returns none.
    [[nodiscard]] std::vector<WorkerAnswer> wait();

  private:
    struct Worker {
        pid_t process = -1;
        int socket = -1;
        std::optional<std::size_t> task;
    };

    void launch(Worker& worker);
    [[noreturn]] void serve(int socket) const;
    [[nodiscard]] WorkerAnswer answer_of(Worker& worker);

    Work work_;
    std::vector<Worker> workers_;
};

} // namespace lamella::app
