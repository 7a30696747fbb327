#pragma once

// Decompression and compression of gzip files.

#include "system/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

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

/// Returns whether a path ends with ".gz", in any case.
[[nodiscard]] bool has_gzip_extension(std::string_view path) noexcept;

/// Returns the bytes as a member of a gzip file, without a name and a time; "" if there are no bytes. Members
/// are joined by concatenation. Equal bytes give equal members.
[[nodiscard]] std::string gzip_member(std::string_view bytes);

} // namespace lamella
