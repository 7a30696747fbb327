#pragma once

// Decompression of Deflate by libdeflate, and the checksums of zip and PNG files. Functions that need zlib
// are in gzip.cpp.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace lamella {

/// Returns the CRC-32 that zip and PNG files use. O(n).
[[nodiscard]] std::uint32_t crc32_of(std::string_view bytes) noexcept;

/// Returns the Adler-32 that ends the pixels of a PNG file. O(n).
[[nodiscard]] std::uint32_t adler32_of(std::string_view bytes) noexcept;

enum class Inflated {
    whole,     ///< the stream filled the buffer exactly and ended with the compressed bytes
    too_short, ///< the stream ended before the buffer was full
    too_long,  ///< the buffer was full before the stream ended
    broken,    ///< not a Deflate stream, truncated, or followed by other data
};

/// Upper bound on the ratio of decompressed to compressed size in Deflate.
inline constexpr std::uint64_t most_inflation = 1032;

/// Returns the default limit for the decompressed size of a file: 64 times its compressed size, at least 64
/// MiB and at most `usual_memory`. Meshes and layers do not compress better than that.
[[nodiscard]] std::uint64_t usual_most_unpacked(std::uint64_t compressed_bytes);

/// Decompresses a raw Deflate stream into a buffer of exactly the expected size. Pages of the buffer beyond
/// the end of the stream are not touched.
[[nodiscard]] Inflated inflate(std::string_view compressed, std::span<std::byte> room);

/// Returns the first `most` decompressed bytes of a raw Deflate stream; fewer if the stream ends or is
/// damaged before.
[[nodiscard]] std::string first_inflated(std::string_view compressed, std::size_t most);

} // namespace lamella
