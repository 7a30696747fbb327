#pragma once

// Buffers for the bytes of a layer. Their memory is reused for the next layer, because fresh pages would take
// as much time as the formatting.

#include "core/pages.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstring>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// Writes text and returns its end.
inline char* put_text(char* out, std::string_view text) noexcept {
    std::memcpy(out, text.data(), text.size());
    return out + text.size();
}

/// Writes the bytes of a value as they are in memory, and returns their end.
template <class T>
char* put_value(char* out, T value) noexcept {
    std::memcpy(out, &value, sizeof value);
    return out + sizeof value;
}

template <class T>
std::string bytes_of(T value) {
    return {reinterpret_cast<const char*>(&value), sizeof value};
}

/// A growing byte array. Bytes beyond its end are not initialised.
class ByteBuffer {
  public:
    /// Returns space for `size` bytes after the end. The caller writes there and passes the new end to
    /// `end_at`. Earlier pointers become invalid.
    [[nodiscard]] char* room(std::size_t size) {
        if (bytes_.size() - size_ < size)
            grow(size);
        assert(bytes_.size() - size_ >= size);
        return bytes_.data() + size_;
    }
    void end_at(const char* end) noexcept {
        size_ = static_cast<std::size_t>(end - bytes_.data());
        assert(size_ <= bytes_.size());
    }

    void append(std::string_view text) {
        if (text.empty())
            return;
        char* const out = room(text.size());
        std::memcpy(out, text.data(), text.size());
        end_at(out + text.size());
    }

    void clear() noexcept { size_ = 0; }
    [[nodiscard]] std::string_view view() const noexcept { return {bytes_.data(), size_}; }
    [[nodiscard]] char* data() noexcept { return bytes_.data(); }

  private:
    void grow(std::size_t size) {
        PageArray<char> bytes(std::max(size_ + size, bytes_.size() + bytes_.size() / 2));
        if (size_ > 0)
            std::memcpy(bytes.data(), bytes_.data(), size_);
        bytes_ = std::move(bytes);
    }

    PageArray<char> bytes_;
    std::size_t size_ = 0;
};

/// A pool of reusable buffers, for any number of threads.
class BufferPool : public std::enable_shared_from_this<BufferPool> {
  public:
    BufferPool() { idle_.reserve(most_idle); }

    /// Returns an empty buffer. It returns to the pool when the last pointer to it is destroyed.
    [[nodiscard]] std::shared_ptr<ByteBuffer> take() {
        ByteBuffer buffer;
        {
            const std::lock_guard lock(mutex_);
            if (!idle_.empty()) {
                buffer = std::move(idle_.back());
                idle_.pop_back();
            }
        }
        buffer.clear();
        return {new ByteBuffer(std::move(buffer)), [pool = shared_from_this()](ByteBuffer* used) {
                    pool->give_back(std::unique_ptr<ByteBuffer>(used));
                }};
    }

  private:
    // This is enough for all threads; more would waste memory.
    static constexpr std::size_t most_idle = 64;

    void give_back(std::unique_ptr<ByteBuffer> buffer) noexcept {
        const std::lock_guard lock(mutex_);
        if (idle_.size() < most_idle)
            idle_.push_back(std::move(*buffer));
    }

    std::mutex mutex_;
    std::vector<ByteBuffer> idle_;
};

} // namespace lamella
