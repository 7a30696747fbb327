#include "heap.hpp"

#include "system/program_start.hpp"

namespace lamella::app {

void keep_freed_memory() noexcept {
    set_heap(32 << 20, 64 << 20);
}

void return_freed_memory() noexcept {
    set_heap(4 << 20, 8 << 20);
}

} // namespace lamella::app
