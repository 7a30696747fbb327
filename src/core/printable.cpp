#include "lamella/core/printable.hpp"

#include <algorithm>

namespace lamella {

namespace {

unsigned byte_at(std::string_view text, std::size_t i) {
    return i < text.size() ? static_cast<unsigned char>(text[i]) : 0;
}

/// Returns the length of the well-formed UTF-8 sequence at i (Unicode, table 3-7), 0 if there is none.
std::size_t utf8_length(std::string_view text, std::size_t i) {
    const unsigned lead = byte_at(text, i);
    const auto continues = [&](std::size_t k, unsigned low = 0x80, unsigned high = 0xBF) {
        return byte_at(text, i + k) >= low && byte_at(text, i + k) <= high;
    };
    if (lead < 0x80)
        return 1;
    if (lead >= 0xC2 && lead <= 0xDF)
        return continues(1) ? 2 : 0;
    if (lead >= 0xE0 && lead <= 0xEF)
        return continues(1, lead == 0xE0 ? 0xA0 : 0x80, lead == 0xED ? 0x9F : 0xBF) && continues(2) ? 3 : 0;
    if (lead >= 0xF0 && lead <= 0xF4)
        return continues(1, lead == 0xF0 ? 0x90 : 0x80, lead == 0xF4 ? 0x8F : 0xBF) && continues(2) &&
                       continues(3)
                   ? 4
                   : 0;
    return 0;
}

} // namespace

bool is_utf8(std::string_view text) noexcept {
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = utf8_length(text, i);
        if (length == 0)
            return false;
        i += length;
    }
    return true;
}

std::string printable(std::string_view text, std::size_t max_bytes) {
    constexpr std::string_view digits = "0123456789abcdef";
    std::string line;
    for (std::size_t i = 0; i < text.size();) {
        const std::size_t length = utf8_length(text, i);
        const unsigned lead = byte_at(text, i);
        // U+0080 to U+009F are control characters, too. U+FFFE and U+FFFF are not, but XML forbids them.
        const bool control = lead < 0x20 || lead == 0x7F || (lead == 0xC2 && byte_at(text, i + 1) < 0xA0);
        const bool none = length == 3 && text.substr(i, 3) >= "\xEF\xBF\xBE" && lead == 0xEF;
        if (i + std::max<std::size_t>(length, 1) > max_bytes)
            return line + "...";
        if (length != 0 && !control && !none) {
            line += text.substr(i, length);
            i += length;
        } else {
            line += "\\x";
            line += digits[lead >> 4];
            line += digits[lead & 15];
            ++i;
        }
    }
    return line;
}

} // namespace lamella
