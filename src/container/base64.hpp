#pragma once

// Base64 encoding of bytes.

#include <cstddef>
#include <string>
#include <string_view>

namespace lamella {

/// Returns the number of characters that `bytes` bytes take in Base64.
[[nodiscard]] constexpr std::size_t base64_size(std::size_t bytes) noexcept {
    return (bytes + 2) / 3 * 4;
}

/// Appends the bytes in Base64 (RFC 4648, section 4), padded, without line breaks. O(n).
void append_base64(std::string_view bytes, std::string& out);

} // namespace lamella
