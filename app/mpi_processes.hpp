#pragma once

// Processes of an MPI job. Only the source of this header includes MPI.

#include "lamella/jobs/processes.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>

namespace lamella::app {

/// The processes started by `mpirun`. There must be only one object of this kind, used by one thread. If a
/// message fails or a process ends early, MPI ends all of them.
class MpiProcesses final : public Communicator {
  public:
    /// Upper bound on the size of one message; longer ones are split.
    static constexpr std::uint64_t most_bytes = std::uint64_t{1} << 28;

    explicit MpiProcesses(std::uint64_t most_bytes_at_once = most_bytes);
    ~MpiProcesses() override;
    MpiProcesses(const MpiProcesses&) = delete;
    MpiProcesses& operator=(const MpiProcesses&) = delete;

    [[nodiscard]] std::size_t process() const noexcept override { return process_; }
    [[nodiscard]] std::size_t size() const noexcept override { return size_; }
    void sum(std::span<std::uint64_t> values) override;
    [[nodiscard]] std::vector<std::string> gather(std::string_view mine) override;
    [[nodiscard]] std::vector<std::uint64_t> exchange(std::span<const std::uint64_t> outgoing) override;
    void exchange(std::span<const std::span<const std::byte>> outgoing,
                  std::span<const std::span<std::byte>> incoming) override;

    /// Waits until all processes have called it. Returns false if some have not after `patience`.
    [[nodiscard]] bool meet(std::chrono::seconds patience);
    /// Ends all processes. Must be called if this process cannot continue and others may be waiting for it.
    [[noreturn]] static void abort(int exit_code);

  private:
    std::uint64_t most_at_once_;
    std::size_t process_ = 0;
    std::size_t size_ = 1;
};

} // namespace lamella::app
