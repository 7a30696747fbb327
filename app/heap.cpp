#include "heap.hpp"

#include <malloc.h>

namespace lamella::app {

namespace {

/// Blocks from `own_pages` bytes on are given back when they are freed, others where more than `kept` bytes
/// lie free. By itself the allocator learns both from the blocks that it meets, and would never forget them.
void set_heap(int own_pages, int kept) noexcept {
    mallopt(M_MMAP_THRESHOLD, own_pages);
    mallopt(M_TRIM_THRESHOLD, kept);
}

} // namespace

void keep_freed_memory() noexcept {
    set_heap(32 << 20, 64 << 20);
}

void return_freed_memory() noexcept {
    set_heap(4 << 20, 8 << 20);
}

} // namespace lamella::app
