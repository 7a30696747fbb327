#pragma once

// Bytes that wait for their reader.

#include "core/spill_file.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Bytes written one after the other, and read at any place: in memory up to a bound, beyond it in a file
/// without a name (see SpillFile). For one thread.
class ByteStore {
  public:
    /// Keeps about `most_in_memory` bytes in memory, whole blocks of 8 MiB, and a block more.
    explicit ByteStore(std::uint64_t most_in_memory = std::uint64_t{32} << 20)
        : most_blocks_(most_in_memory / block_bytes) {}

    /// Throws Error{output} where there is no room for the file.
    void add(std::string_view bytes);
    [[nodiscard]] std::uint64_t size() const noexcept { return size_; }

    /// The bytes from `place` on; there must be so many.
    void read(std::uint64_t place, std::span<char> bytes) const;

    static constexpr std::size_t block_bytes = std::size_t{8} << 20;

  private:
    std::size_t most_blocks_;
    std::vector<std::string> blocks_; ///< full ones, the first of all bytes
    std::optional<SpillFile> file_;   ///< full blocks that follow those
    std::uint64_t spilled_ = 0;
    std::string last_; ///< what follows, less than a block
    std::uint64_t size_ = 0;
};

} // namespace lamella
