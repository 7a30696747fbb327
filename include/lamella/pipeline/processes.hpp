#pragma once

// Communication of several processes that slice one job together, on one machine or on many.

#include "lamella/core/api.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Communication between processes, which are numbered from 0. This is an interface, so that the library does
/// not depend on a message passing library. Except for send and receive, all processes must call the same
/// functions in the same order. Messages may have any length. If one process ends early, the others end, too.
class Communicator {
  public:
    Communicator() = default;
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;
    virtual ~Communicator() = default;

    /// Returns the number of this process.
    [[nodiscard]] virtual std::size_t process() const noexcept = 0;
    /// Returns the number of processes.
    [[nodiscard]] virtual std::size_t size() const noexcept = 0;

    /// Replaces each element by its sum over all processes.
    virtual void sum(std::span<std::uint64_t> values) = 0;
    /// Returns the texts of all processes, in their order, on each of them.
    [[nodiscard]] virtual std::vector<std::string> gather(std::string_view mine) = 0;
    /// Sends outgoing[p] to process p, and returns the numbers received, in the order of the processes.
    [[nodiscard]] virtual std::vector<std::uint64_t> exchange(std::span<const std::uint64_t> outgoing) = 0;
    /// Sends `outgoing[p]` to process p, and receives `incoming[p]` from it; both know the length of each
    /// message.
    virtual void exchange(std::span<const std::span<const std::byte>> outgoing,
                          std::span<const std::span<std::byte>> incoming) = 0;
    /// Sends bytes from one process to another.
    virtual void send(std::size_t to, std::string_view bytes) = 0;
    [[nodiscard]] virtual std::string receive(std::size_t from) = 0;
};

/// Returns the communicator for a job of a single process.
[[nodiscard]] Communicator& alone() noexcept;

/// Figures of each process, as in docs/scaling.md.
struct ProcessFigures {
    std::uint64_t triangles_read = 0;   ///< triangles in its part of the files
    std::uint64_t triangles_sliced = 0; ///< triangles that its planes cut
    std::uint64_t bytes_sent = 0;       ///< bytes of triangles sent to other processes
    std::uint64_t planes = 0;
    std::uint64_t points = 0;
    double read_seconds = 0;     ///< time of three passes over its part of the files
    double exchange_seconds = 0; ///< including waiting for other processes
    double slice_seconds = 0;    ///< including formatting
    double write_seconds = 0;
};

} // namespace lamella
LAMELLA_API_END
