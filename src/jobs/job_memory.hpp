#pragma once

// Limits and estimates of the memory of a job.

#include "lamella/inputs/read_file.hpp"
#include "lamella/jobs/file_job.hpp"
#include "lamella/mesh/mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

struct JobMemory {
    std::uint64_t limit = 0; ///< in bytes
    bool asked = false; ///< true if the job sets it; otherwise it is three quarters of the available memory

    explicit JobMemory(const FileJob& job);

    /// Upper bound on the memory of the data about planes. It is at most a gigabyte unless the job sets a
    /// limit, since a layer height in the wrong unit requires far more.
    [[nodiscard]] std::uint64_t of_planes() const noexcept {
        return asked ? limit : std::min(limit, std::uint64_t{1} << 30);
    }

    /// Upper bound on the points in flight through the sink. It is that of slice_to, or a smaller one with
    /// which the points and the data made of them take at most a quarter of the limit. If the job sets the
    /// limit, it is not larger for large meshes.
    [[nodiscard]] std::uint64_t points_in_flight(std::uint64_t triangles = 0) const noexcept;

    /// Memory of the program, its threads and its data about each plane, some of which is stored for each
    /// shape. `statistics` adds the memory of layer statistics.
    [[nodiscard]] static std::uint64_t overhead(unsigned threads, std::uint64_t planes,
                                                std::size_t shapes = 1, bool statistics = false) noexcept;

    /// Memory of triangles in transit between processes, and of the output that a process keeps until all
    /// processes write.
    [[nodiscard]] std::uint64_t of_messages(std::size_t processes) const noexcept;
    /// Number of triangles that each of several processes reads between two exchanges. These triangles take
    /// at most half of `of_messages` in transit, even if all go to one process; but the number is at least
    /// 4096.
    [[nodiscard]] std::uint64_t triangles_in_a_round(std::size_t processes) const noexcept;
    /// Bytes of the output that each of several processes keeps in memory: half of `of_messages`.
    [[nodiscard]] std::uint64_t of_output() const noexcept;

    /// Number of bytes of standard input that are kept in memory. A larger mesh could not be sliced in
    /// memory.
    [[nodiscard]] std::uint64_t of_input(unsigned threads) const noexcept;

    /// Upper bound on the memory for slicing meshes in memory one after the other, including the memory of
    /// the program.
    [[nodiscard]] std::uint64_t of_meshes(std::span<const Mesh* const> meshes,
                                          unsigned threads) const noexcept;

    /// Memory for slicing that does not depend on the meshes: `overhead` and the points in flight.
    [[nodiscard]] std::uint64_t besides_meshes(unsigned threads) const noexcept;
    /// Upper bound on the memory for an STL file that is sliced as a whole, without `besides_meshes`.
    [[nodiscard]] std::uint64_t of_whole(const MeshInput& file, unsigned threads) const;
};

} // namespace lamella
