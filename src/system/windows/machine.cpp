#include "core/machine.hpp"

#include <windows.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <thread>

namespace lamella {

unsigned usable_processors() noexcept {
    // A mask has the processors of one group, at most 64; a process with a mask of its own has only one
    // group.
    if (GetActiveProcessorGroupCount() > 1)
        return std::max<unsigned>(1, GetActiveProcessorCount(ALL_PROCESSOR_GROUPS));
    DWORD_PTR process = 0;
    DWORD_PTR system = 0;
    if (GetProcessAffinityMask(GetCurrentProcess(), &process, &system) != 0 && process != 0)
        return static_cast<unsigned>(std::popcount(std::uint64_t{process}));
    return std::max(1U, std::thread::hardware_concurrency());
}

LargeMemory take_large_memory(std::size_t bytes) noexcept {
    // Address space is reserved for one large page more than needed, so that the data can start at a multiple
    // of its size. New memory is zero.
    if (bytes > ~std::size_t{0} - 2 * large_page)
        return {};
    void* const base = VirtualAlloc(nullptr, bytes + large_page, MEM_RESERVE, PAGE_READWRITE);
    if (base == nullptr)
        return {};
    const auto address = reinterpret_cast<std::uintptr_t>(base);
    const std::uintptr_t aligned = (address + large_page - 1) & ~(large_page - 1);
    void* const data = VirtualAlloc(reinterpret_cast<void*>(aligned), bytes, MEM_COMMIT, PAGE_READWRITE);
    if (data == nullptr) {
        VirtualFree(base, 0, MEM_RELEASE);
        return {};
    }
    return {data, bytes};
}

void release_large_memory(LargeMemory memory) noexcept {
    MEMORY_BASIC_INFORMATION region{};
    if (VirtualQuery(memory.data, &region, sizeof region) != 0)
        VirtualFree(region.AllocationBase, 0, MEM_RELEASE);
}

void prefer_large_pages(void* /*data*/, std::size_t /*bytes*/) noexcept {}

void provide_pages(void* /*data*/, std::size_t /*bytes*/) noexcept {}

} // namespace lamella
