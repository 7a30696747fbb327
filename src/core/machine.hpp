#pragma once

// The two resources that the engine asks its machine for: processors and large memory. `system/machine.cpp`
// asks the operating system, `core/plain_machine.cpp` only the standard library; the build compiles one of
// them.

#include <cstddef>

namespace lamella {

/// Size of a large page, bytes. Large memory starts at a multiple of it where the system has such pages.
inline constexpr std::size_t large_page = std::size_t{2} << 20;

/// Returns the number of processors that this process may use; at least 1.
[[nodiscard]] unsigned usable_processors() noexcept;

/// Large memory whose bytes are zero. It starts at a multiple of `large_page`.
struct LargeMemory {
    void* data = nullptr;  ///< nullptr if the machine lacks the memory
    std::size_t bytes = 0; ///< as `release_large_memory` takes them
};
[[nodiscard]] LargeMemory take_large_memory(std::size_t bytes) noexcept;
void release_large_memory(LargeMemory memory) noexcept;

/// Asks for large pages in [data, data + bytes), which holds whole large pages. A hint.
void prefer_large_pages(void* data, std::size_t bytes) noexcept;
/// Lets the machine provide the pages of [data, data + bytes) now, not at the first write. A hint; the
/// content stays.
void provide_pages(void* data, std::size_t bytes) noexcept;

} // namespace lamella
