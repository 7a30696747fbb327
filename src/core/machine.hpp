#pragma once

// The two resources that the engine requests from the machine: processors and large memory. The build
// compiles one of two sources: one in `src/system` uses the operating system, `core/plain_machine.cpp` only
// the standard library.

#include <cstddef>

namespace lamella {

/// Size of a large page, bytes. If the system has such pages, large memory starts at a multiple of it.
inline constexpr std::size_t large_page = std::size_t{2} << 20;

/// Returns the number of processors that this process may use; at least 1.
[[nodiscard]] unsigned usable_processors() noexcept;

/// Large memory whose bytes are zero. It starts at a multiple of `large_page`.
struct LargeMemory {
    void* data = nullptr;  ///< nullptr if there is not enough memory
    std::size_t bytes = 0; ///< to be passed to `release_large_memory`
};
[[nodiscard]] LargeMemory take_large_memory(std::size_t bytes) noexcept;
void release_large_memory(LargeMemory memory) noexcept;

/// Requests large pages for [data, data + bytes), which must consist of whole large pages. The system may
/// ignore it.
void prefer_large_pages(void* data, std::size_t bytes) noexcept;
/// Requests that the pages of [data, data + bytes) are provided now, not at the first write. Their content is
/// kept. The system may ignore it.
void provide_pages(void* data, std::size_t bytes) noexcept;

} // namespace lamella
