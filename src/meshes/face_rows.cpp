#include "meshes/face_rows.hpp"

#include "container/coordinate_text.hpp"
#include "container/text_position.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Returns the number of rows if every line certainly is a row, as in most texts, because no line begins with
/// a blank or ends with a bare CR and there are no comments. Otherwise returns nullopt. Checks sixteen bytes
/// at a time, which is many times faster than parsing each line.
std::optional<std::uint64_t> count_plain_rows(std::string_view text, char comment) {
    if (text.empty() || text[0] <= ' ' || text[0] == comment)
        return std::nullopt;
    using Bytes = signed char __attribute__((vector_size(16)));
    const auto load = [&](std::size_t at) {
        Bytes bytes;
        std::memcpy(&bytes, text.data() + at, sizeof bytes);
        return bytes;
    };
    const auto comment_byte = static_cast<signed char>(comment);
    std::uint64_t count = 0;
    std::size_t at = 1;
    while (at + sizeof(Bytes) <= text.size()) {
        Bytes line_feeds{};
        Bytes doubtful{};
        for (int i = 0; i < 127 && at + sizeof(Bytes) <= text.size();
             ++i, at += sizeof(Bytes)) { // bounded, so that the counts fit into a byte
            const Bytes before = load(at - 1);
            const Bytes here = load(at);
            line_feeds -= here == '\n';
            doubtful |= ((before == '\n') & (here <= ' ')) | ((before == '\r') & (here != '\n')) |
                        (here == comment_byte);
        }
        for (std::size_t k = 0; k < sizeof(Bytes); ++k) {
            if (doubtful[k] != 0)
                return std::nullopt;
            count += static_cast<std::uint64_t>(line_feeds[k]);
        }
    }
    for (; at < text.size(); ++at) {
        const char before = text[at - 1];
        if ((before == '\n' && text[at] <= ' ') || (before == '\r' && text[at] != '\n') ||
            text[at] == comment)
            return std::nullopt;
        count += text[at] == '\n' ? 1 : 0;
    }
    return text.back() == '\n' ? count : count + 1;
}

std::uint64_t count_rows(std::string_view text, char comment) {
    if (const std::optional<std::uint64_t> count = count_plain_rows(text, comment))
        return *count;
    const char* const end = text.data() + text.size();
    std::uint64_t count = 0;
    for (const char* at = skip_blanks(text.data(), end); at != end; at = skip_blanks(at, end)) {
        count += comment != '\0' && *at == comment ? 0 : 1;
        at = skip_to_line_end(at, end);
    }
    return count;
}

} // namespace

/// Skips blanks before the next word of the row.
inline void RowWords::to_word(std::string_view expected) {
    at_ = skip_spaces(at_, end_);
    if (at_ != end_ && !is_line_end(*at_))
        return;
    if (layout_ == RowLayout::words)
        skip_blanks();
    if (at_ == end_ || is_line_end(*at_))
        throw TextFault{offset(), std::string(expected)};
}

double RowWords::coordinate() {
    to_word("a number");
    return take_coordinate();
}

std::int64_t RowWords::integer() {
    to_word("a whole number");
    const char* at = at_;
    const bool negative = *at == '-';
    if (negative || *at == '+')
        ++at;
    const char* const digits = at;
    constexpr std::ptrdiff_t most_digits = 18;
    constexpr std::int64_t too_large = std::int64_t{1} << 40;
    std::uint64_t whole = 0; // wraps around only for longer numbers
    for (; at != end_ && static_cast<unsigned char>(*at - '0') < 10; ++at)
        whole = whole * 10 + static_cast<unsigned char>(*at - '0');
    const std::int64_t value = at - digits <= most_digits ? static_cast<std::int64_t>(whole) : too_large;
    if (at != digits && at != end_ && *at == '.') // some programs write "4.0"
        for (++at; at != end_ && *at == '0';)
            ++at;
    if (at == digits || (at != end_ && !is_blank(*at)))
        throw TextFault{offset(), "a whole number"};
    at_ = at;
    return negative ? -value : value;
}

void RowWords::skip_word() {
    to_word("another value");
    Words::skip_word();
}

void RowWords::skip_list() {
    for (std::int64_t left = count("how many values the list has"); left > 0; --left)
        skip_word();
}

std::int64_t RowWords::count(std::string_view expected) {
    to_word(expected);
    const std::size_t begin = offset();
    const std::int64_t value = integer();
    if (value < 0)
        throw TextFault{begin, std::string(expected)};
    return value;
}

/// Takes a row such as "3 17 4 2": short numbers separated by single blanks, as in most rows of most files.
bool RowWords::take_triangle(FaceChunk& chunk) {
    const char* at = at_;
    if (end_ - at < 2 || at[0] != '3' || at[1] != ' ')
        return false;
    ++at;
    std::array<std::uint32_t, 3> corners{};
    for (std::uint32_t& corner : corners) {
        if (at == end_ || *at != ' ')
            return false;
        const char* const digits = ++at;
        for (; at != end_ && static_cast<unsigned char>(*at - '0') < 10; ++at)
            corner = corner * 10 + static_cast<unsigned char>(*at - '0'); // wraps around only for long
                                                                          // numbers
        constexpr std::ptrdiff_t most_digits = 9;
        if (at == digits || at - digits > most_digits)
            return false;
    }
    if (at != end_ && !is_blank(*at))
        return false;
    chunk.triangles.push_back(corners);
    at_ = at;
    return true;
}

void RowWords::add_face(FaceChunk& chunk) {
    at_ = skip_spaces(at_, end_);
    if (take_triangle(chunk))
        return;
    constexpr std::string_view expected = "how many corners the face has";
    to_word(expected);
    const std::size_t begin = offset();
    corners_.clear();
    for (std::int64_t left = count(expected); left > 0; --left) {
        const std::int64_t v = integer();
        corners_.push_back(v >= 0 && v < std::int64_t{FaceChunk::no_vertex} ? static_cast<std::uint32_t>(v)
                                                                            : FaceChunk::no_vertex);
    }
    chunk.add_face(corners_, begin);
}

void RowWords::add_strips(FaceChunk& chunk) {
    TriangleStrip strip;
    for (std::int64_t left = count("how many numbers of vertices there are"); left > 0; --left) {
        const std::int64_t v = integer();
        if (v < 0) {
            strip.restart();
            continue;
        }
        if (const auto triangle =
                strip.add(static_cast<std::uint32_t>(std::min<std::int64_t>(v, FaceChunk::no_vertex))))
            chunk.triangles.push_back(*triangle);
    }
}

const char* RowWords::end_row() {
    if (layout_ == RowLayout::words)
        return at_;
    at_ = skip_spaces(at_, end_);
    if (at_ != end_ && !is_line_end(*at_)) {
        if (layout_ == RowLayout::exact_lines)
            throw TextFault{offset(), "the end of the line"};
        at_ = skip_to_line_end(at_, end_);
    }
    return at_;
}

namespace {

class RowsReader {
  public:
    RowsReader(const ByteSource& source, const FaceRows& rows, Remarks& remarks, ReadLimits& limits,
               const Execution& execution)
        : source_(source), rows_(rows), remarks_(remarks), limits_(limits), executor_(execution),
          progress_(execution, Stage::read, source.bytes.size()), text_(source.text()) {}

    MeshFile run() {
        read(rows_.any_lines ? RowLayout::exact_lines : RowLayout::lines);
        if (fault_ && rows_.any_lines) {
            const std::size_t first_odd_line = fault_->offset;
            read(RowLayout::words);
            if (fault_ && count_rows(text_.substr(rows_.begin), rows_.comment) == all_rows()) {
                read(RowLayout::lines);
                if (!fault_)
                    remarks_.add(fmt::format("line {}: left out what the line has beyond the values of its "
                                             "row (this is the first)",
                                             line_of(source_, first_odd_line)));
            }
        }
        if (fault_)
            refuse_text(source_, *fault_);
        const std::size_t rest = chunks_.back().rest;
        MeshFile file = make_mesh_file(source_, *parser_, chunks_, 0, remarks_, executor_);
        if (rest != nowhere)
            report_rest(rest);
        progress_.finish();
        return file;
    }

  private:
    [[nodiscard]] std::uint64_t all_rows() const { return rows_.rows + rows_.more_rows; }

    /// Reads all chunks with this layout, up to the first fault.
    void read(RowLayout layout) {
        for (const FaceChunk& chunk : chunks_)
            give_back_chunk(chunk, limits_);
        chunks_.clear();
        const bool words = layout == RowLayout::words;
        const std::uint64_t rows = words ? all_rows() : rows_.rows;
        ChunkFormat<FaceChunk> format;
        format.parse = [this, layout, rows](FaceChunk& chunk, std::uint64_t most_triangles) {
            parse(chunk, layout, rows, most_triangles);
        };
        format.find_cut = [this](std::size_t from, std::size_t limit) {
            return find_line(text_, from, limit);
        };
        format.guess = [this](std::vector<FaceChunk>& chunks) {
            guess_rows(chunks);
        };
        // The beginning of a row of words is known only when the row before it has been parsed.
        parser_.emplace(source_, rows_.begin, std::move(format), executor_, progress_,
                        words ? 1 : face_chunks_ahead(executor_));
        chunks_ = parser_->rest([&](const FaceChunk& chunk) { count_chunk(chunk, limits_); });
        const FaceChunk& last = chunks_.back();
        fault_ = last.fault;
        if (last.after < rows && (!fault_ || (words && fault_->offset == text_.size())))
            fault_ = {text_.size(),
                      fmt::format("the file ends after {} rows, expected {} by {} (it is cut off, or the "
                                  "numbers there are wrong)",
                                  last.after, rows, rows_.counted_where),
                      false};
    }

    /// Reads the rows of a chunk. After the last row needed it skips to the end of the text.
    void parse(FaceChunk& chunk, RowLayout layout, std::uint64_t rows, std::uint64_t most_triangles) const {
        const char* const begin = text_.data();
        const char* const end = begin + text_.size();
        const char* const limit = begin + chunk.limit;
        RowWords words(text_, chunk.begin, layout);
        const char* at = skip_blanks(begin + chunk.begin, end);
        chunk.after = chunk.before;
        try {
            for (; at < limit; at = skip_blanks(at, end)) {
                if (rows_.comment != '\0' && *at == rows_.comment) {
                    at = skip_to_line_end(at, end);
                    continue;
                }
                if (chunk.after >= rows) {
                    if (layout == RowLayout::words)
                        throw TextFault{static_cast<std::size_t>(at - begin),
                                        fmt::format("the end of the file after the {} rows of {}", rows,
                                                    rows_.counted_where)};
                    chunk.rest = static_cast<std::size_t>(at - begin);
                    at = end;
                    break;
                }
                words.move_to(at);
                rows_.read_row(chunk.after, words, chunk);
                if (chunk.triangles.size() > most_triangles)
                    break;
                ++chunk.after;
                at = words.end_row();
            }
        } catch (TextFault& fault) {
            chunk.fault = std::move(fault);
        }
        chunk.end = static_cast<std::size_t>(at - begin);
        assert(chunk.begin <= chunk.end && chunk.end <= text_.size());
        assert(chunk.before <= chunk.after && (chunk.after <= rows || chunk.after == chunk.before));
    }

    /// Reports lines after the last row: the counts in the file are wrong, and these lines are lost. `begin`
    /// is the offset after the rows that are needed.
    void report_rest(std::size_t begin) {
        const char* const end = text_.data() + text_.size();
        const char* at = text_.data() + begin;
        for (std::uint64_t left = rows_.more_rows; at != end && left > 0; at = skip_blanks(at, end)) {
            left -= rows_.comment != '\0' && *at == rows_.comment ? 0 : 1;
            at = skip_to_line_end(at, end);
        }
        const auto location = static_cast<std::size_t>(at - text_.data());
        if (const std::uint64_t count = count_rows(text_.substr(location), rows_.comment); count > 0)
            remarks_.add(fmt::format("line {}: left out {} from here on, beyond the {} rows of {}",
                                     line_of(source_, location), counted(count, "line"), all_rows(),
                                     rows_.counted_where));
    }

    /// Counts the lines of each chunk to guess the number of its first row.
    void guess_rows(std::vector<FaceChunk>& chunks) {
        std::vector<std::uint64_t> counts(chunks.size());
        executor_.for_chunks(chunks.size() - 1, 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            counts[i] =
                count_rows(text_.substr(chunks[i].begin, chunks[i].limit - chunks[i].begin), rows_.comment);
        });
        for (std::size_t i = 1; i < chunks.size(); ++i)
            chunks[i].before = chunks[i - 1].before + counts[i - 1];
    }

    const ByteSource& source_;
    const FaceRows& rows_;
    Remarks& remarks_;
    ReadLimits& limits_;
    Executor executor_;
    ProgressMeter progress_;
    std::string_view text_;
    std::optional<ChunkParser<FaceChunk>> parser_;
    std::vector<FaceChunk> chunks_;
    std::optional<TextFault> fault_;
};

} // namespace

MeshFile read_face_rows(const ByteSource& source, const FaceRows& rows, Remarks& remarks, ReadLimits& limits,
                        const Execution& execution) {
    return RowsReader(source, rows, remarks, limits, execution).run();
}

} // namespace lamella
