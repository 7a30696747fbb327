#include "container/text_chunks.hpp"

#include "lamella/core/error.hpp"

#include "container/text_position.hpp"

#include <fmt/format.h>

namespace lamella {

std::uint64_t line_of(const ByteSource& source, std::size_t offset) {
    constexpr std::size_t chunk = std::size_t{1} << 24;
    std::uint64_t line = 1;
    for (std::size_t at = 0; at < offset; at += chunk) {
        const std::size_t bytes = std::min(chunk, offset - at);
        line += line_at(source.text().substr(at, bytes + 1), bytes) - 1;
        release(source, source.bytes.subspan(at, bytes));
    }
    return line;
}

void refuse_text(const ByteSource& source, const TextFault& fault) {
    const std::string location = fmt::format("{}: line {}", source.name, line_of(source, fault.offset));
    if (!fault.found)
        throw Error(ErrorKind::input, fmt::format("{}: {}", location, fault.text));
    const std::string_view rest = source.text().substr(fault.offset);
    const std::string_view word = word_at(rest.data(), rest.data() + rest.size());
    const std::string found = rest.empty()   ? "the end of the file"
                              : word.empty() ? "the end of the line"
                                             : fmt::format("'{}'", printable(word, 40));
    throw Error(ErrorKind::input, fmt::format("{}: found {}, expected {}", location, found, fault.text));
}

std::size_t find_line(std::string_view text, std::size_t from, std::size_t limit) {
    while (from < limit && !(is_line_end(text[from]) && text[from - 1] != '\\' && text[from - 1] != '\r'))
        ++from;
    while (from < limit && is_blank(text[from]))
        ++from;
    return from < limit ? from : nowhere;
}

} // namespace lamella
