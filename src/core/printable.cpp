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

/// Returns whether the well-formed sequence at i is a control character or another one that changes how its
/// neighbours are shown: U+0080 to U+009F, which are control characters, too; the line ends U+2028 and
/// U+2029; and the controls of bidirectional text, with which a name can pretend to be another one.
bool is_unfit(std::string_view text, std::size_t i, std::size_t length) {
    const unsigned lead = byte_at(text, i);
    const unsigned second = byte_at(text, i + 1);
    const unsigned third = byte_at(text, i + 2);
    if (length == 1)
        return lead < 0x20 || lead == 0x7F;
    if (length == 2)
        return (lead == 0xC2 && second < 0xA0) || (lead == 0xD8 && second == 0x9C); // U+061C
    if (length != 3)
        return false;
    if (lead == 0xE2 && second == 0x80)
        return third == 0x8E || third == 0x8F ||
               (third >= 0xA8 && third <= 0xAE); // U+200E, F, U+2028 to U+202E
    if (lead == 0xE2 && second == 0x81)
        return third >= 0xA6 && third <= 0xA9;              // U+2066 to U+2069
    return lead == 0xEF && second == 0xBF && third >= 0xBE; // U+FFFE and U+FFFF, which XML forbids
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
        if (i + std::max<std::size_t>(length, 1) > max_bytes)
            return line + "...";
        if (length != 0 && !is_unfit(text, i, length)) {
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
