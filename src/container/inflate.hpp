#pragma once

// Unpacking Deflate, and the checksums of zip and PNG files. What zlib does of it is in gzip.cpp.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

/// CRC-32 as zip and PNG files have it. O(n).
[[nodiscard]] std::uint32_t crc32_of(std::string_view bytes) noexcept;

/// Adler-32, which ends the pixels of a PNG file. O(n).
[[nodiscard]] std::uint32_t adler32_of(std::string_view bytes) noexcept;

enum class Inflated {
    whole,     ///< exactly as many bytes as there was room for, and the packed bytes ended with them
    too_short, ///< the stream ended before the room was full
    too_long,  ///< the room was full before the stream ended
    broken,    ///< no Deflate stream, cut off, or followed by something else
};

/// No byte of a Deflate stream stands for more than this many.
inline constexpr std::uint64_t most_inflation = 1032;

/// What a packed file may unpack to unless somebody says more: 64 times its size, or 64 MiB where that is
/// more, which is more than meshes and layers do; but no more than `usual_memory`.
[[nodiscard]] std::uint64_t usual_most_unpacked(std::uint64_t packed_bytes);

/// Unpacks a raw Deflate stream into a room of exactly the size that it ought to have. Pages of the room that
/// it does not reach are not touched.
[[nodiscard]] Inflated inflate(std::string_view packed, std::span<std::byte> room);

/// The first bytes of what a raw Deflate stream holds, `most` of them or all that there are: up to where it
/// is broken, if it is.
[[nodiscard]] std::string first_inflated(std::string_view packed, std::size_t most);

} // namespace lamella
