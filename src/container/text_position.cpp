#include "container/text_position.hpp"

#include <algorithm>

namespace lamella {

std::uint64_t line_at(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    auto line = static_cast<std::uint64_t>(1 + std::count(before.begin(), before.end(), '\n'));
    for (std::size_t at = before.find('\r'); at != std::string_view::npos; at = before.find('\r', at + 1))
        line += text.substr(at + 1, 1) != "\n" ? 1 : 0;
    return line;
}

std::uint64_t LineCounter::line(std::size_t offset) {
    const std::size_t begin = std::min(offset, offset_);
    const std::size_t distance = std::max(offset, offset_) - begin;
    const std::uint64_t lines = line_at(text_.substr(begin), distance) - 1;
    line_ = offset < offset_ ? line_ - lines : line_ + lines;
    offset_ = offset;
    return line_;
}

} // namespace lamella
