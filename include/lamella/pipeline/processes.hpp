#pragma once

// Several processes that slice one job together, on one machine or on many.

#include "lamella/core/api.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// How processes, counted from 0, talk to each other: an interface, so that the library needs no message
/// passing of its own. All but send and receive are called by all processes, in the same order; messages may
/// have any length. A process that is gone ends the others.
class Communicator {
  public:
    Communicator() = default;
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;
    virtual ~Communicator() = default;

    /// Which one this is.
    [[nodiscard]] virtual std::size_t process() const noexcept = 0;
    /// How many there are.
    [[nodiscard]] virtual std::size_t size() const noexcept = 0;

    /// Adds up over all processes, element by element; all of them get the sums.
    virtual void sum(std::span<std::uint64_t> values) = 0;
    /// What each process says, in their order, on all of them.
    [[nodiscard]] virtual std::vector<std::string> gather(std::string_view mine) = 0;
    /// One number to each process; returns one from each.
    [[nodiscard]] virtual std::vector<std::uint64_t> exchange(std::span<const std::uint64_t> outgoing) = 0;
    /// `outgoing[p]` goes to process p, `incoming[p]` comes from there; both know how long each message is.
    virtual void exchange(std::span<const std::span<const std::byte>> outgoing,
                          std::span<const std::span<std::byte>> incoming) = 0;
    /// From one process to another.
    virtual void send(std::size_t to, std::string_view bytes) = 0;
    [[nodiscard]] virtual std::string receive(std::size_t from) = 0;
};

/// A process that works by itself: sums and what is gathered are its own, and it sends to nobody.
[[nodiscard]] Communicator& alone() noexcept;

/// What each process did: the figures of docs/scaling.md.
struct ProcessFigures {
    std::uint64_t triangles_read = 0;   ///< of its part of the files
    std::uint64_t triangles_sliced = 0; ///< that its planes need
    std::uint64_t bytes_sent = 0;       ///< triangles for other processes
    std::uint64_t planes = 0;
    std::uint64_t points = 0;
    double read_seconds = 0;     ///< three passes over its part of the files
    double exchange_seconds = 0; ///< waiting for other processes included
    double slice_seconds = 0;    ///< with formatting
    double write_seconds = 0;
};

} // namespace lamella
LAMELLA_API_END
