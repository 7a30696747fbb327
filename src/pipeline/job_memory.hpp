#pragma once

// How much memory a job may take, and what it takes of it besides its meshes.

#include "lamella/mesh/mesh.hpp"
#include "lamella/pipeline/slice_file.hpp"
#include "lamella/read/mesh_input.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

struct JobMemory {
    std::uint64_t limit = 0; ///< bytes
    bool asked = false;      ///< by the job; else it is three quarters of what is there

    explicit JobMemory(const FileJob& job);

    /// What notes about planes may take: without a limit that was asked for, no more than a gigabyte, as
    /// a layer height that is a thousand times too small asks for more.
    [[nodiscard]] std::uint64_t of_planes() const noexcept {
        return asked ? limit : std::min(limit, std::uint64_t{1} << 30);
    }

    /// How many points may be on their way through the sink: as many as slice_to has on its own, or fewer so
    /// that they and what is made of them take no more than a quarter of the limit.
    [[nodiscard]] std::uint64_t points_in_flight(unsigned threads) const noexcept;

    /// What the program, its threads and its notes about each plane take; on a plate, there are some for each
    /// shape. `statistics`: of layers.
    [[nodiscard]] static std::uint64_t overhead(unsigned threads, std::uint64_t planes,
                                                std::size_t shapes = 1, bool statistics = false) noexcept;

    /// What goes from process to process, and what a process of several keeps of its output until all write.
    [[nodiscard]] std::uint64_t of_messages(std::size_t processes) const noexcept;
    /// How many triangles each of several processes reads before they exchange them: so many that those on
    /// their way take no more than half of `of_messages`, also where all go to one process.
    [[nodiscard]] std::uint64_t triangles_in_a_round(std::size_t processes) const noexcept;
    /// Bytes of the output that a process of several keeps in memory: half of `of_messages`.
    [[nodiscard]] std::uint64_t of_output() const noexcept;

    /// How many bytes of standard input to keep in memory: no more than could be sliced there.
    [[nodiscard]] std::uint64_t of_input(unsigned threads) const noexcept;

    /// What slicing meshes in memory, one after the other, takes at most, all else included.
    [[nodiscard]] std::uint64_t of_meshes(std::span<const Mesh* const> meshes,
                                          unsigned threads) const noexcept;

    /// What slicing takes whatever the meshes: `overhead`, and points on their way.
    [[nodiscard]] std::uint64_t besides_meshes(unsigned threads) const noexcept;
    /// What an STL file that is sliced whole takes at most, besides.
    [[nodiscard]] std::uint64_t of_whole(const MeshInput& file, bool placed, unsigned threads) const;
};

} // namespace lamella
