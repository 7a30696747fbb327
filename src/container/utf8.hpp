#pragma once

// UTF-8 encoding of characters.

#include <cstdint>
#include <string>

namespace lamella {

/// Appends the character with the number `c`, which must be below 2^21, in UTF-8.
inline void append_utf8(std::string& to, std::uint32_t c) {
    if (c < 0x80) {
        to += static_cast<char>(c);
        return;
    }
    const unsigned tails = c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
    to += static_cast<char>((0xFF00U >> (tails + 1) & 0xFFU) | (c >> (6 * tails)));
    for (unsigned k = tails; k-- > 0;)
        to += static_cast<char>(0x80U | ((c >> (6 * k)) & 0x3FU));
}

} // namespace lamella
