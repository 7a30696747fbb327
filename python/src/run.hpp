#pragma once

// Runs long work that Python calls, without the global interpreter lock, with progress, and interruptible by
// Ctrl-C.

#include "lamella/core/execution.hpp"

#include "gil_release.hpp"

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

namespace lamella::python {

/// Progress reports of the library's threads, kept until the calling thread collects them, because only that
/// thread calls into Python. Only the latest progress of a stage is kept, so that a slow listener delays
/// nothing.
class ProgressBox {
  public:
    void put(const Progress& progress);
    [[nodiscard]] std::vector<Progress> take();

  private:
    std::mutex mutex_;
    std::vector<Progress> waiting_;
};

/// Calls `listener(stage, done, total)` for all reports in the box. None is no listener.
void report(ProgressBox& box, const pybind11::object& listener);

/// Interval at which a waiting thread of Python checks for signals.
inline constexpr std::chrono::milliseconds between_signals{50};

/// Runs pending signal handlers of Python, and throws the exception that one raises, such as
/// KeyboardInterrupt. Does nothing in threads other than Python's main thread.
void check_signals();

/// Runs the work on a new thread. Meanwhile the calling thread waits without the interpreter lock, reports
/// progress, and checks for signals about twenty times a second. Returns or throws as the work does. If the
/// listener or a signal handler raises an exception, the work is stopped and the exception is thrown.
void run(unsigned threads, const pybind11::object& listener,
         const std::function<void(const Execution&)>& work);

/// Does the same for work with a result.
template <class Work>
[[nodiscard]] auto result_of(unsigned threads, const pybind11::object& listener, const Work& work) {
    std::optional<decltype(work(Execution{}))> result;
    run(threads, listener, [&](const Execution& execution) { result.emplace(work(execution)); });
    return std::move(*result);
}

/// Does the same as `run`, except that an error raised by a signal handler is thrown at once, while work that
/// ignores the request to stop continues in the background. The work must therefore keep alive everything
/// that it uses.
void run_alone(const std::function<void(const Execution&)>& work);

/// Waits until such work has ended, which was asked to stop, or for five seconds. For the end of the process,
/// which destroys what the work may use.
void wait_for_work_left_alone();

/// Returns the result of work on layers with this many points in total. The work must keep alive everything
/// that it uses. If there are few points, the calling thread does the work itself, because starting a thread
/// would take longer.
template <class Work>
[[nodiscard]] auto result_of_points(std::size_t points, const Work& work) {
    constexpr std::size_t few = 1000;
    if (points <= few) {
        const GilRelease released;
        return work(Execution{.threads = 1});
    }
    const auto result = std::make_shared<std::optional<decltype(work(Execution{}))>>();
    run_alone([result, work](const Execution& execution) { result->emplace(work(execution)); });
    return std::move(**result);
}

} // namespace lamella::python
