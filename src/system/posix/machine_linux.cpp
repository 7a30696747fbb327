#include "core/machine.hpp"

#include <sched.h>
#include <sys/mman.h>

#include <algorithm>
#include <cstdint>
#include <thread>

namespace lamella {

unsigned usable_processors() noexcept {
    // The affinity mask reflects taskset and containers; hardware_concurrency may not.
    cpu_set_t set;
    if (sched_getaffinity(0, sizeof set, &set) == 0)
        return static_cast<unsigned>(std::max(1, CPU_COUNT(&set)));
    return std::max(1U, std::thread::hardware_concurrency());
}

LargeMemory take_large_memory(std::size_t bytes) noexcept {
    // A fresh mapping is zero. It is one large page longer than needed, so that the data can start on one;
    // the memory before that is returned.
    if (bytes > ~std::size_t{0} - 2 * large_page)
        return {};
    const std::size_t mapped = bytes + large_page;
    void* const base =
        mmap(nullptr, mapped, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (base == MAP_FAILED)
        return {};
    const auto address = reinterpret_cast<std::uintptr_t>(base);
    const std::uintptr_t aligned = (address + large_page - 1) & ~(large_page - 1);
    if (aligned != address)
        munmap(base, aligned - address);
    const LargeMemory memory{
        reinterpret_cast<void*>(aligned), // NOLINT(performance-no-int-to-ptr): alignment of a mapping
        mapped - (aligned - address)};
    prefer_large_pages(memory.data, memory.bytes);
    return memory;
}

void release_large_memory(LargeMemory memory) noexcept {
    munmap(memory.data, memory.bytes);
}

void prefer_large_pages(void* data, std::size_t bytes) noexcept {
    madvise(data, bytes, MADV_HUGEPAGE);
}

void provide_pages(void* data, std::size_t bytes) noexcept {
#ifdef MADV_POPULATE_WRITE
    constexpr int populate_write = MADV_POPULATE_WRITE;
#else
    constexpr int populate_write = 23; // headers of an older system than the one that will run this
#endif
    madvise(data, bytes, populate_write);
}

} // namespace lamella
