#pragma once

// A buffer for bytes that are read later.

#include "system/spill_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Bytes that are appended in order and read from any offset. They are kept in memory up to a bound and
/// beyond it in an anonymous file (see SpillFile). For one thread.
class ByteStore {
  public:
    /// Keeps up to `most_in_memory` bytes, rounded to whole chunks of 8 MiB, in memory, plus one chunk.
    explicit ByteStore(std::uint64_t most_in_memory = std::uint64_t{32} << 20)
        : most_blocks_(most_in_memory / block_bytes) {}

    /// Appends bytes. Throws Error{output} if the file system is full.
    void add(std::string_view bytes);
    [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

    /// Copies bytes.size() bytes from offset `position` on into `bytes`. Requires that the store holds them.
    void read(std::uint64_t position, std::span<char> bytes) const;

    static constexpr std::size_t block_bytes = std::size_t{8} << 20;

  private:
    std::size_t most_blocks_;
    std::vector<std::string> blocks_; ///< full chunks at the beginning
    std::optional<SpillFile> file_;   ///< full chunks that follow those in memory
    std::uint64_t spilled_ = 0;
    std::string last_; ///< the last bytes, less than a chunk
    std::uint64_t size_ = 0;
};

} // namespace lamella
