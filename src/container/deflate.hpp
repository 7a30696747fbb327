#pragma once

// Compression in pieces that any threads can make and that are joined by writing them one after the other.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

/// The CRC-32 (`crc32_of`) of a text and a second one of `second_size` bytes after it, from those of the two.
/// O(log second_size).
[[nodiscard]] std::uint32_t crc32_joined(std::uint32_t first, std::uint32_t second,
                                         std::uint64_t second_size) noexcept;

/// Makes pieces of a raw Deflate stream. Each can be read without those before it and ends on a whole byte,
/// so pieces made by several deflaters may be put together in any order; `deflate_end` ends the stream. Equal
/// bytes give equal pieces, whichever deflater makes them. For one thread at a time.
class Deflater {
  public:
    /// The quick setting: formatting a layer must not be much faster than this.
    Deflater();
    ~Deflater();
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;

    /// Appends `bytes` as one piece; nothing for no bytes.
    void append_piece(std::string_view bytes, std::string& out);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// What stands after the last piece.
inline constexpr std::string_view deflate_end{"\x03\x00", 2};

/// A whole raw Deflate stream.
[[nodiscard]] std::string deflated(std::string_view bytes);

} // namespace lamella
