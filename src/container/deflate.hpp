#pragma once

// Deflate compression in chunks, which several threads can make and which are joined by concatenation.

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

namespace lamella {

/// Returns the CRC-32 (`crc32_of`) of the concatenation of two texts from their CRCs; the second has
/// `second_size` bytes. O(log second_size).
[[nodiscard]] std::uint32_t crc32_joined(std::uint32_t first, std::uint32_t second,
                                         std::uint64_t second_size) noexcept;

/// Makes chunks of a raw Deflate stream. Each chunk can be read without the ones before it and ends on a byte
/// boundary, so chunks of several deflaters can be joined in any order; `deflate_end` ends the stream. Equal
/// bytes give equal chunks, no matter which deflater makes them. For one thread at a time.
class Deflater {
  public:
    /// Uses the fast setting, so that compressing a layer is not much slower than formatting it.
    Deflater();
    ~Deflater();
    Deflater(const Deflater&) = delete;
    Deflater& operator=(const Deflater&) = delete;

    /// Appends `bytes` as one chunk; appends nothing if there are no bytes.
    void append_chunk(std::string_view bytes, std::string& out);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// The bytes that follow the last chunk.
inline constexpr std::string_view deflate_end{"\x03\x00", 2};

/// Returns the bytes as a whole raw Deflate stream.
[[nodiscard]] std::string deflated(std::string_view bytes);

} // namespace lamella
