#pragma once

// Large uninitialised arrays. Fresh memory in 4 KB pages costs more than all the arithmetic of slicing, so
// large arrays request pages of 2 MB, and only the pages that are touched are allocated.

#include <cassert>
#include <cstddef>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

namespace lamella {

class Executor;

/// Initial content of memory.
enum class Fill { none, zero };

/// Anonymous memory that starts at a multiple of 64 bytes. Throws std::bad_alloc.
class Pages {
  public:
    Pages() = default;
    explicit Pages(std::size_t bytes, Fill fill = Fill::none);
    ~Pages();
    Pages(const Pages&) = delete;
    Pages& operator=(const Pages&) = delete;
    Pages(Pages&& other) noexcept
        : data_(std::exchange(other.data_, nullptr)), bytes_(std::exchange(other.bytes_, 0)) {}
    Pages& operator=(Pages&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(bytes_, other.bytes_);
        return *this;
    }

    [[nodiscard]] void* data() const noexcept { return data_; }

  private:
    void* data_ = nullptr;
    std::size_t bytes_ = 0;
};

/// An array of trivial values, or of atomics of trivial values, in Pages.
template <class T>
class PageArray {
    static_assert(std::is_trivially_destructible_v<T>);

  public:
    PageArray() = default;
    explicit PageArray(std::size_t size, Fill fill = Fill::none)
        : pages_(size <= ~std::size_t{0} / sizeof(T) ? size * sizeof(T) : ~std::size_t{0}, fill),
          size_(size) {} // a size beyond all memory must fail, not overflow

    [[nodiscard]] T* data() const noexcept { return static_cast<T*>(pages_.data()); }
    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    T& operator[](std::size_t i) const noexcept {
        assert(i < size_);
        return data()[i];
    }
    [[nodiscard]] std::span<T> span() const noexcept { return {data(), size_}; }

  private:
    Pages pages_;
    std::size_t size_ = 0;
};

/// Requests large pages for [data, data + bytes) and lets all workers touch the pages that are entirely in
/// it. The content does not change. If there are no large pages, this has no effect on anything but speed.
void make_pages_ready(Executor& executor, void* data, std::size_t bytes);

/// Resizes an empty vector. All workers touch its fresh pages first, because the resizing thread would do so
/// alone, which is slower.
template <class T>
void resize_in_huge_pages(Executor& executor, std::vector<T>& values, std::size_t size) {
    values.reserve(size);
    make_pages_ready(executor, values.data(), size * sizeof(T));
    values.resize(size);
}

} // namespace lamella
