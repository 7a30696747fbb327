#pragma once

// Files packed with gzip.

#include "core/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace lamella {

/// Whether the bytes begin as a gzip file does.
[[nodiscard]] bool is_gzip(std::span<const std::byte> bytes) noexcept;

/// What a gzip file holds, of one member or several, in memory and under the same name; any other source as
/// it is. How much comes out is found by unpacking, never taken from the file; more than `max_bytes` (0:
/// usual_most_unpacked) is Error{limit} as soon as it is reached. Checksums are compared. Throws Error{input}
/// naming the byte where the file is broken, cut off, followed by something else, or has nothing in it;
/// Error{cancelled} soon after a stop is requested.
[[nodiscard]] ByteSource unpacked(const ByteSource& source, std::uint64_t max_bytes,
                                  const Execution& execution = {});

} // namespace lamella
