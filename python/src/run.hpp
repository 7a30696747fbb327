#pragma once

// Long work, called from Python: without the global interpreter lock, with progress, and Ctrl-C heard.

#include "lamella/core/execution.hpp"

#include "unlocked.hpp"

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

/// What threads of the library have to tell, kept until the thread of the caller comes by: it alone calls
/// into Python. Of one stage only the latest progress is kept, so that a slow listener holds nobody up.
class ProgressBox {
  public:
    void put(const Progress& progress);
    [[nodiscard]] std::vector<Progress> take();

  private:
    std::mutex mutex_;
    std::vector<Progress> waiting_;
};

/// Calls `listener(stage, done, total)` for everything in the box. None is no listener.
void tell(ProgressBox& box, const pybind11::object& listener);

/// How long a thread of Python waits before it looks for signals again.
inline constexpr std::chrono::milliseconds between_signals{50};

/// Throws what a signal handler of Python raised, such as KeyboardInterrupt. Only Python's main thread has
/// such handlers; elsewhere this does nothing.
void check_signals();

/// Runs the work on a thread of its own, while the calling thread waits without the interpreter lock, passes
/// progress on, and hears signals some twenty times a second. Returns or throws what the work does; when the
/// listener or a signal handler raises, the work is stopped and their exception is thrown.
void run(unsigned threads, const pybind11::object& listener,
         const std::function<void(const Execution&)>& work);

/// The same for work that gives something.
template <class Work>
[[nodiscard]] auto result_of(unsigned threads, const pybind11::object& listener, const Work& work) {
    std::optional<decltype(work(Execution{}))> result;
    run(threads, listener, [&](const Execution& execution) { result.emplace(work(execution)); });
    return std::move(*result);
}

/// Runs work that keeps alive whatever it uses. The same, but for one thing: what a signal handler raises is
/// thrown at once, and work that does not hear the request to stop goes on by itself until its end.
void run_alone(const std::function<void(const Execution&)>& work);

/// What work on layers with this many points in all gives. It keeps alive whatever it uses. Few points take
/// less time than a thread does: the calling thread works on them itself.
template <class Work>
[[nodiscard]] auto result_of_points(std::size_t points, const Work& work) {
    constexpr std::size_t few = 1000;
    if (points <= few) {
        const Unlocked released;
        return work(Execution{.threads = 1});
    }
    const auto result = std::make_shared<std::optional<decltype(work(Execution{}))>>();
    run_alone([result, work](const Execution& execution) { result->emplace(work(execution)); });
    return std::move(**result);
}

} // namespace lamella::python
