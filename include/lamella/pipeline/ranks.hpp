#pragma once

// Several processes that slice one job together, on one machine or on many.

#include "lamella/core/execution.hpp"
#include "lamella/pipeline/slice_file.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// How processes ("ranks", counted from 0) talk to each other: an interface, so that the library needs no
/// message passing of its own. All but send and receive are called by all ranks, in the same order; messages
/// may have any length. A rank that is gone ends the others.
class Communicator {
  public:
    Communicator() = default;
    Communicator(const Communicator&) = delete;
    Communicator& operator=(const Communicator&) = delete;
    virtual ~Communicator() = default;

    [[nodiscard]] virtual std::size_t rank() const noexcept = 0;
    [[nodiscard]] virtual std::size_t size() const noexcept = 0;

    /// Adds up over all ranks, element by element; all of them get the sums.
    virtual void sum(std::span<std::uint64_t> values) = 0;
    /// What each rank says, in their order, on all of them.
    [[nodiscard]] virtual std::vector<std::string> gather(std::string_view mine) = 0;
    /// One number to each rank; returns one from each.
    [[nodiscard]] virtual std::vector<std::uint64_t> exchange(std::span<const std::uint64_t> outgoing) = 0;
    /// `outgoing[r]` goes to rank r, `incoming[r]` comes from there; both know how long each message is.
    virtual void exchange(std::span<const std::span<const std::byte>> outgoing,
                          std::span<const std::span<std::byte>> incoming) = 0;
    /// From one rank to another.
    virtual void send(std::size_t to, std::string_view bytes) = 0;
    [[nodiscard]] virtual std::string receive(std::size_t from) = 0;
};

/// What each rank did: the figures of docs/scaling.md.
struct RankFigures {
    std::uint64_t triangles_read = 0;   ///< of its shares
    std::uint64_t triangles_sliced = 0; ///< that its slab needs
    std::uint64_t bytes_sent = 0;       ///< triangles for other ranks
    std::uint64_t planes = 0;
    std::uint64_t points = 0;
    double read_seconds = 0;     ///< three passes over its shares
    double exchange_seconds = 0; ///< waiting for other ranks included
    double slice_seconds = 0;    ///< with formatting
    double write_seconds = 0;
};

/// What slice_file does, by all ranks together, each of which calls this with the same job. The same bytes
/// are written as by one process, whatever the number of ranks; the result is that of the whole job, on every
/// rank, with the longest times of all.
///
/// Each rank reads a share of each binary STL file, and slices a slab of planes of equal work. Other files,
/// and whatever needs the whole mesh (other engines, inspection, repair, adaptive layers), are read by every
/// rank as a whole; the planes are shared out all the same. Formats whose files are layers one after the
/// other are written by all ranks, each its part, so the output must be on a file system that all of them
/// see; layers for other formats and for standard output go to rank 0, which writes.
///
/// Errors are agreed on: whatever is thrown on one rank, all of them throw. Throws what slice_file throws,
/// and Error{usage} for standard input, which reaches one rank only.
/// `figures`: where not null, those of all ranks.
[[nodiscard]] FileResult slice_file(const FileJob& job, Communicator& ranks, const Execution& execution = {},
                                    std::vector<RankFigures>* figures = nullptr);

} // namespace lamella
