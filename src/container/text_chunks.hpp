#pragma once

// Parses texts in chunks on several threads; the result is that of a sequential parser.

#include "container/coordinate_text.hpp"
#include "core/executor.hpp"
#include "core/lower_case.hpp"
#include "system/byte_source.hpp"

#include <algorithm>
#include <cassert>
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

/// Returns the text after a byte order mark and blanks.
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

/// Returns whether the word is this keyword, given in lower case; the word may be in any case.
[[nodiscard]] inline bool matches(std::string_view word, std::string_view keyword) {
    return word.size() == keyword.size() && std::equal(word.begin(), word.end(), keyword.begin(),
                                                       [](char w, char k) { return lower_case(w) == k; });
}

/// The reason why a text is unreadable.
struct TextFault {
    std::size_t offset;
    std::string text;  ///< expected text; the whole message if `found` is false
    bool found = true; ///< the error shows the word at the offset
};

/// A cursor over the words of a text.
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

    /// Skips blanks and returns whether the line continues.
    bool skip_blanks_in_line() {
        at_ = skip_spaces(at_, end_);
        return at_ != end_ && !is_line_end(*at_);
    }

    /// Returns the word that begins here (empty at the end).
    [[nodiscard]] std::string_view peek() const { return word_at(at_, end_); }

    void skip_word() { at_ += peek().size(); }

    void skip_line() { at_ = skip_to_line_end(at_, end_); }

    /// Skips blanks, and lines that begin with '#'.
    void skip_comments() {
        for (skip_blanks(); at_ != end_ && *at_ == '#'; skip_blanks())
            skip_line();
    }

    /// Skips the keyword if it is the word that begins here.
    bool take(std::string_view keyword) {
        const auto left = static_cast<std::size_t>(end_ - at_);
        if (left < keyword.size() || !matches({at_, keyword.size()}, keyword) ||
            (left > keyword.size() && !is_blank(at_[keyword.size()])))
            return false;
        at_ += keyword.size();
        return true;
    }

    /// Takes the number that begins here; must not be called at the end. Throws TextFault if there is no
    /// number.
    double take_coordinate() {
        double value = 0;
        const char* const stop = parse_coordinate(at_, end_, value);
        if (stop == nullptr)
            throw TextFault{offset(), std::string(expected_instead(peek()))};
        at_ = stop;
        return value + 0.0; // turns -0 into +0
    }

  protected:
    const char* begin_;
    const char* at_;
    const char* end_;
};

/// Returns the number of the line with byte `offset`. O(offset), in little memory.
[[nodiscard]] std::uint64_t line_of(const ByteSource& source, std::size_t offset);

/// Throws Error{input}: "part.obj: line 7: found 'x', expected a number".
[[noreturn]] void refuse_text(const ByteSource& source, const TextFault& fault);

/// Size of a chunk: large enough that the cost of scheduling it is negligible.
inline constexpr std::size_t text_chunk_bytes = std::size_t{1} << 20;

/// Stands for no offset.
inline constexpr std::size_t nowhere = std::numeric_limits<std::size_t>::max();

/// Stands for no bound on the triangles of a chunk.
inline constexpr std::uint64_t all_triangles = std::numeric_limits<std::uint64_t>::max();

/// A chunk of a text. Derived classes contain its contents.
struct TextChunk {
    std::size_t begin = 0;
    std::size_t limit = 0;    ///< parsing ends at the first possible end of a chunk at or after this offset
    std::uint64_t before = 0; ///< state of the parser at the beginning of the chunk

    std::size_t end = 0;     ///< offset at which parsing ended
    std::uint64_t after = 0; ///< `before` of the next chunk
    std::optional<TextFault> fault;
};

/// The parser of a format. Chunk derives from TextChunk.
template <class Chunk>
struct ChunkFormat {
    /// Parses a chunk, but stops before it has more than `most_triangles`. Called by several threads at once.
    std::function<void(Chunk& chunk, std::uint64_t most_triangles)> parse;
    /// Returns an offset in [from, limit) where a chunk probably begins, or `nowhere`. A wrong or missing
    /// offset only costs time.
    std::function<std::size_t(std::size_t from, std::size_t limit)> find_cut;
    /// Guesses the state `before` of all chunks except the first.
    std::function<void(std::vector<Chunk>& chunks)> guess = {};
};

/// Returns the offset of the first word in [from, limit) that begins a line. A line that ends with a
/// backslash continues on the next one.
[[nodiscard]] std::size_t find_line(std::string_view text, std::size_t from, std::size_t limit);

/// Parses several chunks of a text at a time, in parallel, and releases the memory of text that was parsed.
template <class Chunk>
class ChunkParser {
  public:
    /// Parses `chunks_ahead` chunks of `chunk_bytes` at a time.
    ChunkParser(const ByteSource& source, std::size_t begin, ChunkFormat<Chunk> format, Executor& executor,
                ProgressMeter& progress, std::size_t chunks_ahead = 32,
                std::size_t chunk_bytes = text_chunk_bytes)
        : source_(source), text_(source.text()), format_(std::move(format)), executor_(executor),
          progress_(progress), chunk_bytes_(chunk_bytes), stretch_bytes_(chunks_ahead * chunk_bytes),
          at_(begin) {}

    /// Parses the next chunks. The chunks of all calls together cover the text without gaps, up to its end or
    /// to the first fault. The result is that of a sequential parser, because a chunk that was parsed ahead
    /// is used only if the one before it ended where it begins.
    std::vector<Chunk> next() {
        const std::size_t limit = stretch_bytes_ < text_.size() - at_ ? at_ + stretch_bytes_ : text_.size();
        const std::size_t begin = at_;
        std::vector<Chunk> ahead = cut(limit);
        executor_.for_chunks(ahead.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            parse(ahead[i]);
            progress_.add(ahead[i].limit - ahead[i].begin);
        });

        std::vector<Chunk> chunks;
        auto candidate = ahead.begin();
        do {
            executor_.check_cancelled();
            while (candidate != ahead.end() && candidate->begin < at_)
                ++candidate;
            if (candidate != ahead.end() && candidate->begin == at_ && candidate->before == before_) {
                chunks.push_back(std::move(*candidate++));
            } else {
                const auto following = std::find_if(candidate, ahead.end(),
                                                    [&](const Chunk& chunk) { return chunk.begin > at_; });
                chunks.push_back(unparsed(at_, following == ahead.end() ? limit : following->begin, before_));
                parse(chunks.back());
            }
            at_ = chunks.back().end;
            before_ = chunks.back().after;
            assert(chunks.back().begin <= at_ && at_ <= text_.size());
            done_ = at_ >= text_.size() || chunks.back().fault;
        } while (at_ < limit && !done_);
        // Released in one call, because parsing a chunk may read pages of the one before.
        release(source_, source_.bytes.subspan(begin, at_ - begin));
        return chunks;
    }

    /// Parses the rest of the text. Calls `count` with each chunk before the next ones are parsed.
    template <class Count>
    std::vector<Chunk> rest(const Count& count) {
        std::vector<Chunk> chunks;
        while (!done_)
            for (Chunk& chunk : next()) {
                count(chunk);
                chunks.push_back(std::move(chunk));
            }
        return chunks;
    }

    [[nodiscard]] bool done() const noexcept { return done_; }

    /// Returns the line on which the number of triangles of the chunk exceeds `triangles`. Parses the chunk
    /// again up to there.
    [[nodiscard]] std::uint64_t line_of_triangle(const Chunk& chunk, std::uint64_t triangles) const {
        Chunk again = unparsed(chunk.begin, chunk.limit, chunk.before);
        format_.parse(again, triangles);
        return line_of(source_, again.end);
    }

  private:
    static Chunk unparsed(std::size_t begin, std::size_t limit, std::uint64_t before) {
        Chunk chunk;
        chunk.begin = begin;
        chunk.limit = limit;
        chunk.before = before;
        return chunk;
    }

    std::vector<Chunk> cut(std::size_t limit) const {
        std::vector<Chunk> chunks{unparsed(at_, limit, before_)};
        for (std::size_t from = at_ + chunk_bytes_; from < limit; from += chunk_bytes_) {
            // The search ends at the next cut, so that blanks or a word of gigabytes are not scanned again
            // for each chunk.
            const std::size_t begin = format_.find_cut(from, std::min(from + chunk_bytes_, limit));
            if (begin == nowhere)
                continue;
            chunks.back().limit = begin;
            chunks.push_back(unparsed(begin, limit, before_));
        }
        if (format_.guess)
            format_.guess(chunks);
        return chunks;
    }

    void parse(Chunk& chunk) const { format_.parse(chunk, all_triangles); }

    const ByteSource& source_;
    std::string_view text_;
    ChunkFormat<Chunk> format_;
    Executor& executor_;
    ProgressMeter& progress_;
    std::size_t chunk_bytes_;
    std::size_t stretch_bytes_;
    std::size_t at_;
    std::uint64_t before_ = 0;
    bool done_ = false;
};

} // namespace lamella
