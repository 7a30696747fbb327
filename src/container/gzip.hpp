#pragma once

// Decompression of gzip files.

#include "system/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

/// Returns whether the bytes begin with the signature of gzip.
[[nodiscard]] bool is_gzip(std::span<const std::byte> bytes) noexcept;

/// Returns the decompressed contents of a gzip file of one or several members, in memory and with the same
/// name; returns any other source unchanged. The size that the file claims is not used. Checksums are
/// verified. Throws Error{limit} as soon as there are more than `max_bytes` (0: usual_most_unpacked). Throws
/// Error{input} with the offset if the file is damaged, truncated, empty or followed by other data. Throws
/// Error{cancelled} soon after a stop is requested.
[[nodiscard]] ByteSource unpacked(const ByteSource& source, std::uint64_t max_bytes,
                                  const Execution& execution = {});

} // namespace lamella
