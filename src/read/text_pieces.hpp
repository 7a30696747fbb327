#pragma once

// Texts that are parsed in pieces, by many threads, as if it were from front to back.

#include "core/byte_source.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "read/coordinate_text.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
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

/// Whether the word is this keyword, which is in lower case, in any case.
[[nodiscard]] inline bool matches(std::string_view word, std::string_view keyword) {
    return word.size() == keyword.size() && std::equal(word.begin(), word.end(), keyword.begin(),
                                                       [](char w, char k) { return lower_case(w) == k; });
}

/// What makes a text unreadable.
struct TextFault {
    std::size_t offset;
    std::string text;  ///< what was expected, or the whole story where `found` is false
    bool found = true; ///< the error shows the word at the offset
};

/// Walks over a text word by word.
class Words {
  public:
    Words(std::string_view text, std::size_t from)
        : begin_(text.data()), at_(text.data() + from), end_(text.data() + text.size()) {}

    [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
    [[nodiscard]] bool at_end() const { return at_ == end_; }
    [[nodiscard]] const char* position() const { return at_; }
    [[nodiscard]] const char* text_end() const { return end_; }
    void move_to(const char* position) { at_ = position; }

    void skip_blanks() { at_ = lamella::skip_blanks(at_, end_); }

    /// Skips blanks and says whether the line went on.
    bool skip_blanks_in_line() {
        at_ = skip_spaces(at_, end_);
        return at_ != end_ && !is_line_end(*at_);
    }

    /// The word that begins here (empty at the end).
    [[nodiscard]] std::string_view peek() const { return word_at(at_, end_); }

    void skip_word() { at_ += peek().size(); }

    void skip_line() { at_ = skip_to_line_end(at_, end_); }

    /// Skips blanks, and lines that begin with '#'.
    void skip_comments() {
        for (skip_blanks(); at_ != end_ && *at_ == '#'; skip_blanks())
            skip_line();
    }

    /// Skips the keyword when it is the word that begins here.
    bool take(std::string_view keyword) {
        const auto left = static_cast<std::size_t>(end_ - at_);
        if (left < keyword.size() || !matches({at_, keyword.size()}, keyword) ||
            (left > keyword.size() && !is_blank(at_[keyword.size()])))
            return false;
        at_ += keyword.size();
        return true;
    }

    /// Takes the number that begins here, which is not the end. Throws TextFault where there is none.
    double take_coordinate() {
        double value = 0;
        const char* const stop = parse_coordinate(at_, end_, value);
        if (stop == nullptr)
            throw TextFault{offset(), std::string(expected_instead(peek()))};
        at_ = stop;
        return value + 0.0; // turns -0 into +0, as everywhere
    }

  protected:
    const char* begin_;
    const char* at_;
    const char* end_;
};

/// The number of the line that holds byte `offset`. O(offset), in little memory.
[[nodiscard]] std::uint64_t line_of(const ByteSource& source, std::size_t offset);

/// "part.obj: line 7: found 'x', expected a number", as an Error{input}.
[[noreturn]] void refuse_text(const ByteSource& source, const TextFault& fault);

/// What one thread parses at a time: enough that handing it out does not count.
inline constexpr std::size_t text_piece_bytes = std::size_t{1} << 20;

/// No place in a text.
inline constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

/// No bound for the triangles of a piece.
inline constexpr std::uint64_t all_triangles = std::numeric_limits<std::uint64_t>::max();

/// A piece of a text. What derives from it has what was found there.
struct TextPiece {
    std::size_t begin = 0;
    std::size_t limit = 0;    ///< it is parsed up to the first place for a cut that is not before this
    std::uint64_t before = 0; ///< all that the parser has to know of the text before it

    std::size_t end = 0;     ///< where parsing ended
    std::uint64_t after = 0; ///< `before` of what follows
    std::optional<TextFault> fault;
};

/// How the pieces of a format are parsed. Piece derives from TextPiece.
template <class Piece>
struct PieceFormat {
    /// Parses a piece, but stops before what would give more than `most_triangles`. Called by many threads.
    std::function<void(Piece& piece, std::uint64_t most_triangles)> parse;
    /// A place from `from` on and before `limit` where a piece is likely to begin; else `nowhere`. It need
    /// not look further: what is wrong or missing costs time and nothing else.
    std::function<std::size_t(std::size_t from, std::size_t limit)> find_cut;
    /// Guesses `before` of all pieces but the first.
    std::function<void(std::vector<Piece>& pieces)> guess = {};
};

/// The first place in [from, limit) that is the first word of a line. A line that ends with a backslash goes
/// on in the next one.
[[nodiscard]] std::size_t find_line(std::string_view text, std::size_t from, std::size_t limit);

/// Parses a text stretch by stretch, the pieces of a stretch at the same time, and lets go of the memory of
/// what was parsed.
template <class Piece>
class PieceParser {
  public:
    /// A stretch is `pieces_ahead` pieces of `piece_bytes`.
    PieceParser(const ByteSource& source, std::size_t begin, PieceFormat<Piece> format, Executor& executor,
                ProgressMeter& progress, std::size_t pieces_ahead = 32,
                std::size_t piece_bytes = text_piece_bytes)
        : source_(source), text_(source.text()), format_(std::move(format)), executor_(executor),
          progress_(progress), piece_bytes_(piece_bytes), stretch_bytes_(pieces_ahead * piece_bytes),
          at_(begin) {}

    /// What follows, a stretch further or up to the end. The pieces of all results follow one another without
    /// a gap from the begin of the text to its end or to the first fault, exactly as if it had been parsed
    /// from front to back: a piece that was parsed ahead counts only when the one before it ended where it
    /// begins.
    std::vector<Piece> next() {
        const std::size_t limit = stretch_bytes_ < text_.size() - at_ ? at_ + stretch_bytes_ : text_.size();
        const std::size_t begin = at_;
        std::vector<Piece> ahead = cut(limit);
        executor_.for_chunks(ahead.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            parse(ahead[i]);
            progress_.add(ahead[i].limit - ahead[i].begin);
        });

        std::vector<Piece> pieces;
        auto candidate = ahead.begin();
        do {
            executor_.check_cancelled();
            while (candidate != ahead.end() && candidate->begin < at_)
                ++candidate;
            if (candidate != ahead.end() && candidate->begin == at_ && candidate->before == before_) {
                pieces.push_back(std::move(*candidate++));
            } else {
                const auto following = std::find_if(candidate, ahead.end(),
                                                    [&](const Piece& piece) { return piece.begin > at_; });
                pieces.push_back(unparsed(at_, following == ahead.end() ? limit : following->begin, before_));
                parse(pieces.back());
            }
            at_ = pieces.back().end;
            before_ = pieces.back().after;
            done_ = at_ >= text_.size() || pieces.back().fault;
        } while (at_ < limit && !done_);
        // Not piece by piece: whoever reads the next one brings back pages of this one.
        release(source_, source_.bytes.subspan(begin, at_ - begin));
        return pieces;
    }

    /// All that follows. `count` sees each piece before the next stretch is parsed.
    template <class Count>
    std::vector<Piece> rest(const Count& count) {
        std::vector<Piece> pieces;
        while (!done_)
            for (Piece& piece : next()) {
                count(piece);
                pieces.push_back(std::move(piece));
            }
        return pieces;
    }

    [[nodiscard]] bool done() const noexcept { return done_; }

    /// The line of what makes the piece hold more than these many triangles. Parses it again up to there.
    [[nodiscard]] std::uint64_t line_of_triangle(const Piece& piece, std::uint64_t triangles) const {
        Piece again = unparsed(piece.begin, piece.limit, piece.before);
        format_.parse(again, triangles);
        return line_of(source_, again.end);
    }

  private:
    static Piece unparsed(std::size_t begin, std::size_t limit, std::uint64_t before) {
        Piece piece;
        piece.begin = begin;
        piece.limit = limit;
        piece.before = before;
        return piece;
    }

    std::vector<Piece> cut(std::size_t limit) const {
        std::vector<Piece> pieces{unparsed(at_, limit, before_)};
        for (std::size_t from = at_ + piece_bytes_; from < limit; from += piece_bytes_) {
            // Beyond the next cut nothing is looked at: blanks or a word of gigabytes would be walked over
            // once for each piece.
            const std::size_t begin = format_.find_cut(from, std::min(from + piece_bytes_, limit));
            if (begin == nowhere)
                continue;
            pieces.back().limit = begin;
            pieces.push_back(unparsed(begin, limit, before_));
        }
        if (format_.guess)
            format_.guess(pieces);
        return pieces;
    }

    void parse(Piece& piece) const { format_.parse(piece, all_triangles); }

    const ByteSource& source_;
    std::string_view text_;
    PieceFormat<Piece> format_;
    Executor& executor_;
    ProgressMeter& progress_;
    std::size_t piece_bytes_;
    std::size_t stretch_bytes_;
    std::size_t at_;
    std::uint64_t before_ = 0;
    bool done_ = false;
};

} // namespace lamella
