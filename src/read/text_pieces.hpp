#pragma once

// Texts of lines, cut into pieces that are read at the same time.

#include "container/text_place.hpp"
#include "read/coordinate_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

[[nodiscard]] inline std::size_t after_byte_order_mark(std::string_view text) noexcept {
    return text.substr(0, 3) == "\xEF\xBB\xBF" ? 3 : 0;
}

/// What stands after a byte order mark and blanks.
[[nodiscard]] inline std::string_view after_blanks(std::string_view text) noexcept {
    text.remove_prefix(after_byte_order_mark(text));
    text.remove_prefix(std::min(text.find_first_not_of(" \t\r\n\v\f"), text.size()));
    return text;
}

[[nodiscard]] inline const char* skip_to_line_end(const char* at, const char* end) noexcept {
    while (at != end && !is_line_end(*at))
        ++at;
    return at;
}

/// Skips blanks within a line.
[[nodiscard]] inline const char* skip_spaces(const char* at, const char* end) noexcept {
    while (at != end && is_blank(*at) && !is_line_end(*at))
        ++at;
    return at;
}

/// Skips blanks and empty lines.
[[nodiscard]] inline const char* skip_blanks(const char* at, const char* end) noexcept {
    while (at != end && is_blank(*at))
        ++at;
    return at;
}

/// What one thread reads at a time: enough that handing it out does not count.
inline constexpr std::size_t text_piece_bytes = std::size_t{1} << 20;

/// Where pieces of about a megabyte begin, and the end of the last one. Each begins after the end of a line;
/// one that ends with a backslash goes on in the next line.
[[nodiscard]] inline std::vector<std::size_t> cut_at_lines(std::string_view text, std::size_t begin,
                                                           std::size_t piece_bytes = text_piece_bytes) {
    std::vector<std::size_t> cuts{begin};
    while (text.size() - cuts.back() > piece_bytes) {
        std::size_t at = cuts.back() + piece_bytes;
        while (at < text.size() && !(is_line_end(text[at]) && text[at - 1] != '\\' && text[at - 1] != '\r'))
            ++at;
        while (at < text.size() && is_line_end(text[at]))
            ++at;
        if (at == text.size())
            break;
        cuts.push_back(at);
    }
    cuts.push_back(text.size());
    return cuts;
}

/// "line 7: found 'x', expected a number".
[[nodiscard]] inline std::string found_instead(std::string_view text, std::size_t offset,
                                               std::string_view expected) {
    const char* const at = text.data() + offset;
    const char* const end = text.data() + text.size();
    const std::string_view word = word_at(at, end);
    const std::string found = offset == text.size() ? "the end of the file"
                              : word.empty()        ? "the end of the line"
                                                    : fmt::format("'{}'", printable(word, 40));
    return fmt::format("line {}: found {}, expected {}", line_at(text, offset), found, expected);
}

} // namespace lamella
