#pragma once

// Reads slice files in pieces on all threads; the result is that of a sequential reader.
//
// The reader of a format finds where pieces of a file begin, each of which contains whole layers, by a scan
// that is much faster than parsing. It parses each piece on its own, and then takes the results in the order
// of the file.

#include "lamella/core/commit.hpp"
#include "lamella/core/error.hpp"

#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "core/ordered_stage.hpp"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace lamella {

/// Size of a piece: large enough that the cost of scheduling it is negligible, small enough that the layers
/// of a file are distributed evenly.
inline constexpr std::size_t layer_piece_bytes = std::size_t{1} << 18;

/// Offsets at which pieces begin, ascending. The first one is certain. The others may be wrong if a scan
/// cannot know, for example because it does not recognise comments; this only costs time.
using PieceBegins = std::vector<std::size_t>;

/// Appends a begin of a piece unless the last piece would be too small.
inline void add_piece(PieceBegins& begins, std::size_t begin) {
    if (begin - begins.back() >= layer_piece_bytes)
        begins.push_back(begin);
}

/// The pieces of a text, and the lines on which they begin.
class TextPieces {
  public:
    /// Pieces that begin on these lines. If there are none, one thread reads the pieces in ascending order,
    /// and counts the lines while it reads.
    TextPieces(std::string_view text, PieceBegins begins, std::vector<std::uint64_t> lines = {})
        : text_(text), begins_(std::move(begins)), lines_(std::move(lines)), counter_(text) {}

    [[nodiscard]] const PieceBegins& begins() const noexcept { return begins_; }
    /// Returns the line with byte `begin` of the text. Fast near the beginning of a piece.
    [[nodiscard]] std::uint64_t line(std::size_t begin) const;

  private:
    std::string_view text_;
    PieceBegins begins_;
    std::vector<std::uint64_t> lines_;
    mutable LineCounter counter_; ///< used if there are no lines
};

/// Returns pieces of the text from `begin` on. They begin at the first occurrence of `word` in each chunk.
/// One worker does not read the whole text for that.
[[nodiscard]] TextPieces find_text_pieces(std::string_view text, std::size_t begin, std::string_view word,
                                          Executor& executor);

/// Calls parse(begin, limit) for each piece on all threads, and take(piece) in the order of the file. `parse`
/// ends at the first end of a layer at or after `limit`, or at the end of the file, and returns the piece,
/// whose member `end` is this offset. A piece is taken only if the one before it ended where it begins;
/// otherwise the text from there on is parsed again. Each thread holds at most one piece that is not taken
/// yet. Throws the first error in the order of the file, and Error{cancelled}.
template <class Parse, class Take>
void read_pieces(const PieceBegins& begins, std::size_t end, Executor& executor, const Parse& parse,
                 const Take& take) {
    using Piece = decltype(parse(std::size_t{}, std::size_t{}));
    struct Parsed {
        std::optional<Piece> piece;
        std::exception_ptr error;
    };
    std::size_t at = begins.front();
    const Execution silent; // the readers report progress, in bytes
    ProgressMeter pieces(silent, Stage::read, begins.size());
    run_in_order(executor, pieces, begins.size(), [&](std::uint64_t i) -> Commit {
        const std::size_t limit = i + 1 < begins.size() ? begins[i + 1] : end;
        const auto parsed = std::make_shared<Parsed>();
        try {
            parsed->piece.emplace(parse(begins[i], limit));
        } catch (const Error& error) {
            if (error.kind() == ErrorKind::cancelled)
                throw;
            parsed->error = std::current_exception();
        }
        return [&, i, limit, parsed] {
            const bool follows = at == begins[i];
            if (!follows && at >= limit)
                return; // an earlier piece contains this one
            if (follows && parsed->error)
                std::rethrow_exception(parsed->error);
            if (!follows) {
                parsed->piece.reset();
                parsed->piece.emplace(parse(at, limit));
            }
            assert(parsed->piece->end >= at);
            at = parsed->piece->end;
            take(*std::move(parsed->piece));
        };
    });
}

/// Returns the text with which the element of XML at `begin` starts, up to the value of an attribute. The
/// elements that follow probably start alike.
[[nodiscard]] inline std::string_view start_of_siblings(std::string_view text, std::size_t begin) {
    constexpr std::size_t longest = 64;
    const std::string_view first = text.substr(begin, longest);
    return first.substr(0, first.find_first_of("\"'>"));
}

/// Reads elements of XML that follow one another from `begin`, on line `line`, on. As it is not known where
/// the last one ends, the text is divided a window at a time. parse(begin, limit, line) is as in read_pieces;
/// if the end of a piece is npos, it cannot be read. take(piece, line at its end) returns whether reading
/// goes on.
template <class Parse, class Take>
void read_sibling_pieces(std::string_view text, std::size_t begin, std::uint64_t line, Executor& executor,
                         const Parse& parse, const Take& take) {
    using Piece = decltype(parse(begin, begin, line));
    struct Sibling {
        Piece piece;
        std::size_t end; ///< in the window
        std::uint64_t lines = 0;
    };
    const std::string_view word = start_of_siblings(text, begin);
    std::size_t window_bytes = layer_piece_bytes;
    for (bool more = true; more;) {
        const std::string_view window = text.substr(begin, window_bytes);
        const TextPieces pieces = find_text_pieces(window, 0, word, executor);
        std::size_t end = 0;
        std::uint64_t lines = 0;
        read_pieces(
            pieces.begins(), window.size(), executor,
            [&](std::size_t from, std::size_t to) {
                Piece piece = parse(begin + from, begin + to, line + pieces.line(from) - 1);
                Sibling sibling{std::move(piece), piece.end - begin};
                if (piece.end != std::string_view::npos)
                    sibling.lines = line_at(text.substr(begin + from), sibling.end - from) - 1;
                return sibling;
            },
            [&](Sibling&& sibling) {
                more = more && take(std::move(sibling.piece), line + lines + sibling.lines);
                if (!more)
                    return;
                end = sibling.end;
                lines += sibling.lines;
            });
        more = more && end >= window.size();
        begin += end;
        line += lines;
        window_bytes = 16 * executor.workers() * layer_piece_bytes;
    }
}

} // namespace lamella
