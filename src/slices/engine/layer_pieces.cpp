#include "slices/engine/layer_pieces.hpp"

#include <algorithm>
#include <iterator>

namespace lamella {

std::uint64_t TextPieces::line(std::size_t begin) const {
    if (lines_.empty())
        return counter_.line(begin);
    assert(begin >= begins_.front());
    const auto last = std::prev(std::upper_bound(begins_.begin(), begins_.end(), begin));
    return lines_[static_cast<std::size_t>(last - begins_.begin())] +
           line_at(text_.substr(*last), begin - *last) - 1;
}

TextPieces find_text_pieces(std::string_view text, std::size_t begin, std::string_view word,
                            Executor& executor) {
    if (executor.workers() == 1) {
        PieceBegins begins{begin};
        for (std::size_t found = begin; text.size() - found > layer_piece_bytes;) {
            found = text.find(word, found + layer_piece_bytes);
            if (found == std::string_view::npos)
                break;
            begins.push_back(found);
        }
        return {text, std::move(begins)};
    }
    struct Chunk {
        std::size_t found = std::string_view::npos;
        std::uint64_t lines_before = 0; ///< line ends of the chunk before `found`
        std::uint64_t lines = 0;        ///< all line ends of the chunk
    };
    // The first chunk contains everything before `begin`, too.
    std::vector<Chunk> chunks((text.size() - begin) / layer_piece_bytes + 1);
    executor.for_chunks(chunks.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        const std::size_t from = i == 0 ? 0 : begin + i * layer_piece_bytes;
        const std::size_t to = std::min<std::size_t>(begin + (i + 1) * layer_piece_bytes, text.size());
        // CR and LF on both sides of `to` are one line end, which is counted in the next chunk.
        const std::string_view chunk = text.substr(0, std::min(to + 1, text.size())).substr(from);
        Chunk& result = chunks[i];
        result.lines = line_at(chunk, to - from) - 1;
        if (i == 0)
            return;
        result.found = text.substr(0, std::min(to + word.size() - 1, text.size())).find(word, from);
        if (result.found != std::string_view::npos)
            result.lines_before = line_at(chunk, result.found - from) - 1;
    });
    PieceBegins begins{begin};
    std::vector<std::uint64_t> lines{line_at(text, begin)};
    std::uint64_t line = 1;
    for (const Chunk& chunk : chunks) {
        if (chunk.found != std::string_view::npos) {
            begins.push_back(chunk.found);
            lines.push_back(line + chunk.lines_before);
        }
        line += chunk.lines;
    }
    return {text, std::move(begins), std::move(lines)};
}

} // namespace lamella
