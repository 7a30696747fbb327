#pragma once

// Communication of several processes that slice one job together, on one machine or on many.

#include "lamella/core/execution.hpp"
#include "lamella/jobs/file_job.hpp"
#include "lamella/jobs/file_result.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Communication between processes, which are numbered from 0. This is an interface, so that the library does
/// not depend on a message passing library. All processes must call the same functions in the same order.
/// Messages may have any length. If one process ends early, the others end, too.
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
};

/// Slices a job like the function slice_file without processes, but together with other processes: all of
/// them call this function with the same job. The file is, byte for byte, the one that a single process
/// writes. Each process returns the result of the whole job, in which each time is the longest over all
/// processes.
///
/// Each process slices a range of planes of about equal work, as if it were a shard. It reads a part of each
/// binary STL file. If a file is not binary STL, or if the job needs whole meshes (see FileJob::max_memory),
/// each process reads all files completely. If the format has LayerFormat::chunks, each process writes its
/// layers to its part of the file, which must be on a shared file system. For other formats, standard output
/// and outputs that are no regular files, layers are sent to process 0, which writes them.
///
/// If one process throws an error, all of them throw it. With several processes, a shard, a page, and
/// standard input (which only one process could read) are Error{usage}.
[[nodiscard]] FileResult slice_file(const FileJob& job, const Execution& execution, Communicator& processes);

} // namespace lamella
LAMELLA_API_END
