#pragma once

// Runs work without the interpreter lock; safe even if the interpreter ends in the meantime.

#include <pybind11/pybind11.h>

#include <chrono>
#include <thread>

#ifdef __GLIBCXX__
#include <cxxabi.h>
#endif

namespace lamella::python {

/// Calls a function that may wait for the interpreter lock. When the interpreter ends, Python before 3.14
/// unwinds the stacks of daemon threads that request the lock. Unwinding through a destructor would abort the
/// process, so the thread instead waits here for the end of the process, as in Python 3.14.
template <class Call>
void or_wait_for_the_end(const Call& call) {
#ifdef __GLIBCXX__
    try {
        call();
    } catch (const abi::__forced_unwind&) {
        for (;;)
            std::this_thread::sleep_for(std::chrono::hours(1));
    }
#else
    call();
#endif
}

class GilRelease {
  public:
    GilRelease() : thread_(PyEval_SaveThread()) {}
    GilRelease(const GilRelease&) = delete;
    GilRelease& operator=(const GilRelease&) = delete;
    ~GilRelease() {
        or_wait_for_the_end([this] { PyEval_RestoreThread(thread_); });
    }

  private:
    PyThreadState* thread_;
};

} // namespace lamella::python
