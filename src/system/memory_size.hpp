#pragma once

// The available amount of memory.

#include <cstdint>

namespace lamella {

/// Returns the bytes that this process and others under the same limit can use in total: the physical memory,
/// or less if a control group (of a container or a batch job) limits it. Determined only once.
[[nodiscard]] std::uint64_t memory_size();

/// Returns the default memory limit of a job: three quarters of `memory_size`.
[[nodiscard]] inline std::uint64_t usual_memory() {
    return memory_size() / 4 * 3;
}
/// Returns the requested limit, or the default if that is 0.
[[nodiscard]] inline std::uint64_t memory_limit(std::uint64_t wished) {
    return wished != 0 ? wished : usual_memory();
}
/// Returns what is left of a limit if `held` bytes are in use, at least 1: 0 would mean the default.
[[nodiscard]] inline std::uint64_t memory_left(std::uint64_t limit, std::uint64_t held) {
    return limit > held ? limit - held : 1;
}
/// Returns the part of that limit that the copy of a file may take; a longer file is copied to a temporary
/// file.
[[nodiscard]] inline std::uint64_t memory_of_file(std::uint64_t wished) {
    return memory_limit(wished) / 4;
}

} // namespace lamella
