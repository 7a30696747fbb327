#include "run.hpp"

#include "gil_release.hpp"

#include <chrono>
#include <exception>
#include <memory>
#include <thread>

namespace py = pybind11;

namespace lamella::python {
namespace {

/// Signals the end of the work.
class Event {
  public:
    void ring() {
        const std::lock_guard lock(mutex_);
        rung_ = true;
        changed_.notify_one();
    }

    /// Waits for a moment. Returns true if the work is done.
    bool wait() {
        const GilRelease released;
        std::unique_lock lock(mutex_);
        return changed_.wait_for(lock, between_signals, [&] { return rung_; });
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    bool rung_ = false;
};

/// Counts the threads of `run_alone`, which may outlive the call.
class AloneThreads {
  public:
    /// Never destroyed, because such a thread may end after static objects.
    static AloneThreads& all() {
        static AloneThreads& threads = *new AloneThreads;
        return threads;
    }
    void begin() {
        const std::lock_guard lock(mutex_);
        ++count_;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        --count_;
        changed_.notify_all();
    }
    void wait(std::chrono::seconds most) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, most, [&] { return count_ == 0; });
    }

  private:
    std::mutex mutex_;
    std::condition_variable changed_;
    int count_ = 0;
};

/// Joins without the interpreter lock, because the thread may need a while to end, for example to free
/// gigabytes.
void join(std::thread& worker) {
    const GilRelease released;
    worker.join();
}

} // namespace

void ProgressBox::put(const Progress& progress) {
    const std::lock_guard lock(mutex_);
    if (!waiting_.empty() && waiting_.back().stage == progress.stage)
        waiting_.back() = progress;
    else
        waiting_.push_back(progress);
}

std::vector<Progress> ProgressBox::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(waiting_, {});
}

void report(ProgressBox& box, const py::object& listener) {
    if (listener.is_none())
        return;
    for (const Progress& progress : box.take())
        or_wait_for_the_end([&] { listener(stage_name(progress.stage), progress.done, progress.total); });
}

void check_signals() {
    if (PyErr_CheckSignals() != 0)
        throw py::error_already_set();
}

void run(unsigned threads, const py::object& listener, const std::function<void(const Execution&)>& work) {
    ProgressBox box;
    Event bell;
    std::exception_ptr failure;
    Execution execution{.threads = threads};
    if (!listener.is_none())
        execution.progress = [&box](const Progress& progress) {
            box.put(progress);
        };
    CancelFlag cancel;
    execution.cancel = &cancel;
    std::thread worker([&] {
        try {
            work(execution);
        } catch (...) {
            failure = std::current_exception();
        }
        bell.ring();
    });
    try {
        for (bool done = false; !done;) {
            done = bell.wait();
            report(box, listener);
            check_signals();
        }
    } catch (...) {
        cancel.request();
        join(worker);
        throw;
    }
    join(worker);
    if (failure)
        std::rethrow_exception(failure);
}

void run_alone(const std::function<void(const Execution&)>& work) {
    struct Job {
        std::function<void(const Execution&)> work;
        Event bell;
        CancelFlag cancel;
        std::exception_ptr failure;
    };
    const auto job = std::make_shared<Job>();
    job->work = work;
    AloneThreads::all().begin();
    std::thread([job = std::shared_ptr<Job>(job)]() mutable {
        try {
            job->work(Execution{.threads = 1, .cancel = &job->cancel});
        } catch (...) {
            job->failure = std::current_exception();
        }
        job->bell.ring();
        job.reset();
        AloneThreads::all().end();
    }).detach();
    try {
        while (!job->bell.wait())
            check_signals();
        check_signals();
    } catch (...) {
        job->cancel.request();
        throw;
    }
    if (job->failure)
        std::rethrow_exception(job->failure);
}

void wait_for_work_left_alone() {
    const GilRelease released;
    AloneThreads::all().wait(std::chrono::seconds(5));
}

} // namespace lamella::python
