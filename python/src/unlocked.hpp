#pragma once

// Without the interpreter lock, also where the interpreter ends meanwhile.

#include <pybind11/pybind11.h>

#include <chrono>
#include <thread>

#ifdef __GLIBCXX__
#include <cxxabi.h>
#endif

namespace lamella::python {

/// Calls what may have to wait for the interpreter lock. While the interpreter ends, Python before 3.14 ends
/// the daemon threads that ask for the lock by unwinding their stacks. Destructors do not let that through,
/// and the process would abort; so the thread waits here for the end of the process, as Python 3.14 has it.
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

/// Gives the interpreter lock to others for as long as it lives.
class Unlocked {
  public:
    Unlocked() : thread_(PyEval_SaveThread()) {}
    Unlocked(const Unlocked&) = delete;
    Unlocked& operator=(const Unlocked&) = delete;
    ~Unlocked() {
        or_wait_for_the_end([this] { PyEval_RestoreThread(thread_); });
    }

  private:
    PyThreadState* thread_;
};

} // namespace lamella::python
