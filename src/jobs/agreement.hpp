#pragma once

// Processes that fail together.

#include "lamella/jobs/processes.hpp"

#include "core/pages.hpp"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Communication of processes that fail together. With every message, all processes report whether they have
/// failed. One that fails reports its error in place of its next message, so all others throw this error,
/// too, instead of waiting for it. All processes must call the same functions in the same order until one
/// fails.
class Agreement {
  public:
    /// The communicator must outlive the agreement.
    explicit Agreement(Communicator& processes) : processes_(processes) {}

    [[nodiscard]] std::size_t process() const noexcept { return processes_.process(); }
    [[nodiscard]] std::size_t size() const noexcept { return processes_.size(); }

    /// As Communicator::gather and sum. If processes have failed, they throw the Error of the first one, but
    /// a cancellation only if there is no other error.
    std::vector<std::string> gather(std::string_view mine);
    void sum(std::span<std::uint64_t> values);

    /// Sends `outgoing[p]` to process p. Returns the values received, in the order of the processes. Throws
    /// the errors of `gather`.
    template <class T>
    [[nodiscard]] std::shared_ptr<const PageArray<T>> exchange(std::span<const std::span<const T>> outgoing) {
        std::vector<std::uint64_t> sizes;
        std::vector<std::span<const std::byte>> out;
        for (const std::span<const T> values : outgoing) {
            sizes.push_back(values.size());
            out.push_back(std::as_bytes(values));
        }
        gather({});
        const std::vector<std::uint64_t> coming = processes_.exchange(sizes);
        std::uint64_t total = 0;
        for (const std::uint64_t count : coming)
            total += count;
        auto received = std::make_shared<const PageArray<T>>(total);
        std::vector<std::span<std::byte>> in;
        std::uint64_t at = 0;
        for (const std::uint64_t count : coming) {
            in.push_back(std::as_writable_bytes(received->span().subspan(at, count)));
            at += count;
        }
        gather({}); // the memory of a process may not suffice
        processes_.exchange(out, in);
        return received;
    }

    /// Calls work() once, around everything that a process does, and returns its result. If work() throws on
    /// any process, run() throws the same Error on all of them.
    template <class Work>
    auto run(const Work& work) {
        try {
            return work();
        } catch (...) {
            if (failed_)
                throw; // all processes have this error
            report(std::current_exception());
        }
    }

  private:
    std::vector<std::string> meet(const std::string& message);
    [[noreturn]] void report(const std::exception_ptr& failure);

    Communicator& processes_;
    bool failed_ = false; ///< an error is known to all processes
};

} // namespace lamella
