#pragma once

// Processes that work for this one.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Messages to and from another process.
class WorkerChannel {
  public:
    WorkerChannel() = default;
    WorkerChannel(std::intptr_t in, std::intptr_t out) noexcept : in_(in), out_(out) {}

    /// Returns false if the other process has ended.
    [[nodiscard]] bool send(std::string_view message) const;
    /// Waits for a message. Returns none if the other process has ended.
    [[nodiscard]] std::optional<std::string> receive() const;
    void close() noexcept;

    [[nodiscard]] bool is_open() const noexcept { return in_ != -1; }
    [[nodiscard]] std::intptr_t input() const noexcept { return in_; }

  private:
    [[nodiscard]] bool read(void* data, std::size_t bytes) const;

    std::intptr_t in_ = -1; ///< descriptors or handles
    std::intptr_t out_ = -1;
};

/// The end of a process.
struct ProcessEnd {
    enum class Kind : std::uint8_t { exited, time_is_up, killed, crashed };
    Kind kind = Kind::exited;
    int exit_code = 0;    ///< if it exited
    std::string reason{}; ///< a description for people: a signal, an exception, or an exit code
};

/// A process that works for this one and does not outlive it. It does not receive the interrupts of the user.
class WorkerProcess {
  public:
    /// The work of the process, which then ends with the exit code that this returns.
    using Serve = std::function<int(const WorkerChannel&)>;

    /// Starts the process. Where the system can duplicate this process, the new one calls `serve`. Elsewhere
    /// it is this program with the same arguments, and `introduction` is the first message that it receives
    /// from channel_to_owner(). `others` are all workers so far. Returns an errno, or 0.
    [[nodiscard]] int start(const Serve& serve, std::span<const WorkerProcess> others,
                            std::string_view introduction);
    /// Returns whether the process was started and not finished.
    [[nodiscard]] bool exists() const noexcept { return process_ != -1; }
    [[nodiscard]] const WorkerChannel& channel() const noexcept { return channel_; }

    /// Asks the process to stop (Interrupts::of_owner).
    void ask_to_stop() const noexcept;
    /// Closes the channel and waits for the end of the process.
    ProcessEnd finish() noexcept;
    /// Closes the channel only, so that several processes can end at the same time.
    void close_channel() noexcept { channel_.close(); }

  private:
    std::intptr_t process_ = -1;
    [[maybe_unused]] std::intptr_t stop_ = -1; ///< if the request to stop needs a handle
    WorkerChannel channel_;
};

/// Waits until processes have sent messages or ended, and appends the indices of these. Returns an errno, or
/// 0.
[[nodiscard]] int wait_for_messages(std::span<const WorkerProcess* const> processes, int milliseconds,
                                    std::vector<std::size_t>& ready);

/// Returns whether this process is the program started again by WorkerProcess::start.
[[nodiscard]] bool is_started_as_worker() noexcept;
/// In such a process, returns the channel to its owner.
[[nodiscard]] WorkerChannel channel_to_owner();

} // namespace lamella
