#pragma once

// How much memory there is.

#include <cstdint>

namespace lamella {

/// Bytes that this process and its like can have in all: the physical memory, or less where a control group
/// (of a container, of a batch system's job) says so. Asked of the system once.
[[nodiscard]] std::uint64_t memory_size();

/// Of that, what a run may take unless somebody says more or less: three quarters.
[[nodiscard]] std::uint64_t usual_memory();
/// That, unless somebody wished for another limit than 0.
[[nodiscard]] inline std::uint64_t memory_limit(std::uint64_t wished) {
    return wished != 0 ? wished : usual_memory();
}

} // namespace lamella
