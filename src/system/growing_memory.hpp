#pragma once

// Memory for an unknown number of bytes.

#include <cstddef>
#include <span>

namespace lamella {

/// Memory that grows without copying bytes, because the system moves page tables instead. Throws
/// std::bad_alloc.
class GrowingMemory {
  public:
    GrowingMemory();
    ~GrowingMemory();
    GrowingMemory(const GrowingMemory&) = delete;
    GrowingMemory& operator=(const GrowingMemory&) = delete;

    /// Returns the memory for the next bytes; never empty. It is valid until the next call.
    [[nodiscard]] std::span<std::byte> room();
    /// Marks this many bytes of `room` as used.
    void use(std::size_t bytes) noexcept { size_ += bytes; }

    [[nodiscard]] std::size_t size() const noexcept { return size_; }
    /// Shrinks to the used size, which must not be 0.
    void trim();
    [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {data_, size_}; }

  private:
    void resize(std::size_t bytes);

    std::byte* data_;
    std::size_t size_ = 0;
    std::size_t capacity_;
};

} // namespace lamella
