#include "container/text_position.hpp"

#include <algorithm>

namespace lamella {

std::uint64_t line_at(std::string_view text, std::size_t offset) {
    const std::string_view before = text.substr(0, std::min(offset, text.size()));
    std::uint64_t line = 1;
    for (std::size_t i = 0; i < before.size(); ++i)
        line += before[i] == '\n' || (before[i] == '\r' && text.substr(i + 1, 1) != "\n") ? 1 : 0;
    return line;
}

} // namespace lamella
