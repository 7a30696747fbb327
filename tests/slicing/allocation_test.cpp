// Memory that runs out, at any moment of a run.

#include "lamella/slicing/slice.hpp"

#include "even_planes.hpp"
#include "expect_layers.hpp"
#include "fixtures/meshes.hpp"
#include "fixtures/solids.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <memory>
#include <new>
#include <utility>

namespace {

std::atomic<bool> counting{false};
std::atomic<std::int64_t> left{0}; // allocations until one fails

void* allocated(std::size_t bytes, std::size_t alignment) {
    if (counting.load() && left.fetch_sub(1) == 0)
        throw std::bad_alloc();
    // No function of the standard library gives aligned memory on all systems. The address of the whole is in
    // front.
    auto* const whole = static_cast<std::byte*>(std::malloc(bytes + alignment + sizeof(void*)));
    if (whole == nullptr)
        throw std::bad_alloc();
    void* memory = whole + sizeof(void*);
    std::size_t space = bytes + alignment;
    std::align(alignment, bytes, memory, space);
    std::memcpy(static_cast<std::byte*>(memory) - sizeof(void*), &whole, sizeof whole);
    return memory;
}

void release(void* memory) {
    if (memory == nullptr)
        return;
    void* whole = nullptr;
    std::memcpy(&whole, static_cast<std::byte*>(memory) - sizeof(void*), sizeof whole);
    std::free(whole);
}

} // namespace

// Out of line, since compilers that see both ends take memory of one function freed by another for an error.
[[gnu::noinline]] void* operator new(std::size_t bytes) {
    return allocated(bytes, alignof(std::max_align_t));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, std::align_val_t alignment) {
    return allocated(bytes, static_cast<std::size_t>(alignment));
}
[[gnu::noinline]] void* operator new(std::size_t bytes, const std::nothrow_t& /*nothrow*/) noexcept {
    try {
        return allocated(bytes, alignof(std::max_align_t));
    } catch (const std::bad_alloc&) {
        return nullptr;
    }
}
[[gnu::noinline]] void operator delete(void* memory, const std::nothrow_t& /*nothrow*/) noexcept {
    release(memory);
}
[[gnu::noinline]] void operator delete(void* memory) noexcept {
    release(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t) noexcept {
    release(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::align_val_t) noexcept {
    release(memory);
}
[[gnu::noinline]] void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
    release(memory);
}

namespace lamella::allocation_cases {
namespace {

/// Runs `work` again and again, and each time one allocation later fails; until none does. How many failed.
std::int64_t failures_of(const std::function<void()>& work) {
    for (std::int64_t n = 0;; ++n) {
        left = n;
        counting = true;
        try {
            work();
            counting = false;
            return n;
        } catch (const std::bad_alloc&) {
            counting = false;
        }
    }
}

Mesh bodies(bool indexed) {
    const test::Triangles triangles =
        test::joined({test::rugged_drum(40, 7), test::boxes_sharing_an_upright_edge()});
    return indexed ? Mesh(test::indexed(triangles)) : Mesh(test::soup(triangles));
}

TEST(Allocation, ThatFailsAtAnyMomentOfSlicingIsAnError) {
    const Plan plan = test::even_planes(24);
    for (const bool indexed : {false, true})
        for (const unsigned threads : {1U, 3U}) {
            SCOPED_TRACE(threads);
            const Mesh mesh = bodies(indexed);
            LayerStack stack;
            const std::int64_t failures =
                failures_of([&] { stack = slice(mesh, plan, {.execution = {.threads = threads}}); });
            EXPECT_GT(failures, 50);
            test::expect_same(stack, slice(mesh, plan));
        }
}

// The memory of their points goes back to the slicer then, from a destructor.
TEST(Allocation, ThatFailsWhileLayersAreLetGoOfIsAnError) {
    const Mesh mesh = bodies(false);
    const Plan plan = test::even_planes(24);
    const LayerSink sink{.prepare = [](Layer&& layer) {
        const Layer here = std::move(layer);
        return Commit();
    }};
    for (const unsigned threads : {1U, 3U})
        EXPECT_GT(failures_of([&] {
                      slice_to(sink, mesh, plan, {.execution = {.threads = threads}, .points_in_flight = 1});
                  }),
                  50);
}

} // namespace
} // namespace lamella::allocation_cases
