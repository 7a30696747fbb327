#include "heap.hpp"

#include <malloc.h>

namespace lamella::app {

namespace {

/// Sets two thresholds of the allocator. Freed memory of at least `own_pages` bytes is returned to the system
/// at once, smaller amounts if more than `kept` bytes are free. By default the allocator adapts both
/// thresholds to the sizes that it encounters, and never lowers them again.
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
