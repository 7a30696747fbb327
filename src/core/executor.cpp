#include "core/executor.hpp"

#include "lamella/core/error.hpp"

#include "core/machine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <system_error>
#include <utility>

namespace lamella {

unsigned thread_count(const Execution& execution) noexcept {
    if (execution.threads != 0)
        return execution.threads;
    return usable_processors();
}

Executor::Executor(const Execution& execution)
    : workers_(thread_count(execution)), cancel_(execution.cancel), run_tasks_(execution.run_tasks) {
    if (workers_ > most_threads)
        throw Error(ErrorKind::usage,
                    fmt::format("threads: found {}, expected at most {}", workers_, most_threads));
}

Executor::~Executor() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

void Executor::guarded(unsigned worker) noexcept {
    try {
        (*body_)(worker);
    } catch (...) {
        const std::lock_guard lock(mutex_);
        if (!error_)
            error_ = std::current_exception();
        failed_.store(true, std::memory_order_relaxed);
    }
}

void Executor::work(unsigned worker) {
    std::uint64_t seen = 0;
    std::unique_lock lock(mutex_);
    for (;;) {
        wake_.wait(lock, [&] { return ending_ || region_ != seen; });
        if (ending_)
            return;
        seen = region_;
        lock.unlock();
        guarded(worker);
        lock.lock();
        if (--running_ == 0)
            idle_.notify_one();
    }
}

void Executor::start_threads() {
    for (auto worker = static_cast<unsigned>(threads_.size()) + 1; worker < workers_; ++worker)
        try {
            threads_.emplace_back([this, worker] { work(worker); });
        } catch (const std::system_error&) { // no more threads are allowed, or there is no memory for their
                                             // stacks
            workers_ = worker;
        }
}

void Executor::run(const std::function<void(unsigned)>& body) {
    failed_.store(false, std::memory_order_relaxed);
    if (run_tasks_)
        run_as_tasks(body);
    else
        run_here(body);
    if (error_)
        std::rethrow_exception(std::exchange(error_, nullptr));
    check_cancelled();
}

void Executor::run_as_tasks(const std::function<void(unsigned)>& body) {
    body_ = &body;
    std::atomic<unsigned> done{0};
    run_tasks_(workers_, [&](unsigned worker) {
        guarded(worker);
        ++done;
    });
    body_ = nullptr;
    if (done != workers_ && !error_) // after an error, a pool may well skip the other tasks
        throw Error(ErrorKind::usage,
                    fmt::format("run_tasks of an Execution ran {} of {} tasks", done.load(), workers_));
}

void Executor::run_here(const std::function<void(unsigned)>& body) {
    start_threads();
    body_ = &body;
    {
        const std::lock_guard lock(mutex_);
        running_ = workers_ - 1;
        ++region_;
    }
    wake_.notify_all();
    guarded(0);
    {
        std::unique_lock lock(mutex_);
        idle_.wait(lock, [&] { return running_ == 0; });
    }
    body_ = nullptr;
}

void Executor::for_chunks(std::uint64_t n, std::uint64_t chunk,
                          const std::function<void(std::uint64_t, std::uint64_t, unsigned)>& body) {
    chunk = std::max<std::uint64_t>(chunk, 1);
    if (workers_ == 1 || n <= chunk) {
        for (std::uint64_t begin = 0; begin < n; begin += chunk) {
            check_cancelled();
            body(begin, std::min(n, begin + chunk), 0);
        }
        return;
    }
    std::atomic<std::uint64_t> next{0};
    run([&](unsigned worker) {
        while (!stopping()) {
            const std::uint64_t begin = next.fetch_add(chunk, std::memory_order_relaxed);
            if (begin >= n)
                return;
            body(begin, std::min(n, begin + chunk), worker);
        }
    });
}

void Executor::check_cancelled() const {
    if (cancel_ != nullptr && cancel_->requested())
        throw Error(ErrorKind::cancelled, "cancelled");
}

ProgressMeter::ProgressMeter(const Execution& execution, Stage stage, std::uint64_t total)
    : callback_(execution.progress), stage_(stage), total_(total),
      step_(std::max<std::uint64_t>(1, total / 100)) {
    report(0);
}

void ProgressMeter::add(std::uint64_t amount) {
    if (!callback_)
        return;
    const std::uint64_t before = done_.fetch_add(amount, std::memory_order_relaxed);
    const std::uint64_t after = before + amount;
    if (before / step_ != after / step_ && after < total_)
        report(after);
}

void ProgressMeter::finish() {
    report(total_);
}

void ProgressMeter::report(std::uint64_t done) {
    if (!callback_)
        return;
    const std::lock_guard lock(mutex_);
    if (done < reported_)
        return; // another thread has reported a later value
    reported_ = done;
    callback_({stage_, done, total_});
}

} // namespace lamella
