#include "read/face_rows.hpp"

#include "lamella/core/error.hpp"

#include "container/text_place.hpp"
#include "core/executor.hpp"
#include "read/coordinate_text.hpp"
#include "read/text_pieces.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <optional>
#include <utility>

namespace lamella {

namespace {

/// Calls visit(at) for each row from `begin` to `end` until it says false; `visit` returns where the next
/// line may begin.
template <class Visit>
void for_rows(const char* begin, const char* end, char comment, Visit visit) {
    for (const char* at = skip_blanks(begin, end); at != nullptr && at != end;) {
        if (comment != '\0' && *at == comment)
            at = skip_to_line_end(at, end);
        else
            at = visit(at);
        if (at != nullptr)
            at = skip_blanks(at, end);
    }
}

/// A stretch of the text and the rows in it.
struct RowRange {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::uint64_t first_row = 0;
    std::uint64_t last_row = 0; ///< exclusive
};

/// Reads the rows of one piece, until the triangle with this number is there. Returns where it stopped.
std::size_t read_piece(std::string_view text, const RowRange& range, const FaceRows& rows, RowLayout layout,
                       FacePiece& piece,
                       std::uint64_t last_triangle = std::numeric_limits<std::uint64_t>::max()) {
    std::uint64_t row = range.first_row;
    std::size_t stopped = range.end;
    RowWords words(text.substr(0, range.end), text.data() + range.begin, layout);
    try {
        for_rows(text.data() + range.begin, text.data() + range.end, rows.comment,
                 [&](const char* at) -> const char* {
                     if (row == range.last_row)
                         return nullptr;
                     words.move_to(at);
                     rows.read_row(row++, words, piece);
                     if (piece.triangles.size() > last_triangle) {
                         stopped = static_cast<std::size_t>(at - text.data());
                         return nullptr;
                     }
                     return words.end_row();
                 });
    } catch (TextFault& fault) {
        piece.fault = std::move(fault);
    }
    return stopped;
}

/// How many rows there are, if each line is one for certain, as in most texts: none begins with a blank or
/// ends with a CR alone, and there are no comments. Sixteen bytes at a time, which is many times faster than
/// to look at what each line holds.
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
             ++i, at += sizeof(Bytes)) { // counts fit
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
    for_rows(text.data(), end, comment, [&](const char* at) {
        ++count;
        return skip_to_line_end(at, end);
    });
    return count;
}

} // namespace

/// Skips blanks before the next word of the row.
inline void RowWords::to_word(std::string_view expected) {
    at_ = skip_spaces(at_, end_);
    if (at_ != end_ && !is_line_end(*at_))
        return;
    if (layout_ == RowLayout::words)
        at_ = skip_blanks(at_, end_);
    if (at_ == end_ || is_line_end(*at_))
        throw TextFault{offset(), std::string(expected)};
}

double RowWords::coordinate() {
    to_word("a number");
    double value = 0;
    const char* const stop = parse_coordinate(at_, end_, value);
    if (stop == nullptr)
        throw TextFault{offset(), std::string(expected_instead(word_at(at_, end_)))};
    at_ = stop;
    return value + 0.0; // turns -0 into +0, as everywhere
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
    std::uint64_t whole = 0; // may wrap round, but not with so many digits
    for (; at != end_ && static_cast<unsigned char>(*at - '0') < 10; ++at)
        whole = whole * 10 + static_cast<unsigned char>(*at - '0');
    const std::int64_t value = at - digits <= most_digits ? static_cast<std::int64_t>(whole) : too_large;
    if (at == digits || (at != end_ && !is_blank(*at)))
        throw TextFault{offset(), "a whole number"};
    at_ = at;
    return negative ? -value : value;
}

void RowWords::skip_word() {
    to_word("another value");
    at_ += word_at(at_, end_).size();
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

/// Takes "3 17 4 2", as nearly all rows of most files are: all short numbers with one blank between them.
bool RowWords::take_triangle(FacePiece& piece) {
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
            corner = corner * 10 + static_cast<unsigned char>(*at - '0'); // wraps round for long ones only
        constexpr std::ptrdiff_t most_digits = 9;
        if (at == digits || at - digits > most_digits)
            return false;
    }
    if (at != end_ && !is_blank(*at))
        return false;
    piece.triangles.push_back(corners);
    at_ = at;
    return true;
}

void RowWords::add_face(FacePiece& piece) {
    at_ = skip_spaces(at_, end_);
    if (take_triangle(piece))
        return;
    constexpr std::string_view expected = "how many corners the face has";
    to_word(expected);
    const std::size_t begin = offset();
    corners_.clear();
    for (std::int64_t left = count(expected); left > 0; --left) {
        const std::int64_t v = integer();
        corners_.push_back(v >= 0 && v < std::int64_t{FacePiece::no_vertex} ? static_cast<std::uint32_t>(v)
                                                                            : FacePiece::no_vertex);
    }
    piece.add_face(corners_, begin);
}

void RowWords::add_strips(FacePiece& piece) {
    TriangleStrip strip;
    for (std::int64_t left = count("how many numbers of vertices there are"); left > 0; --left) {
        const std::int64_t v = integer();
        if (v < 0) {
            strip.restart();
            continue;
        }
        if (const auto triangle =
                strip.add(static_cast<std::uint32_t>(std::min<std::int64_t>(v, FacePiece::no_vertex))))
            piece.triangles.push_back(*triangle);
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
        read_lines(rows_.any_lines ? RowLayout::exact_lines : RowLayout::lines);
        if (failure_ && rows_.any_lines)
            read_other_layouts();
        if (failure_)
            throw Error(ErrorKind::input, fmt::format("{}: {}", source_.name, failure_->text));
        tell_thin_faces();
        std::vector<std::uint64_t> ends; // of the pieces, in triangles
        for (const FacePiece& piece : pieces_)
            ends.push_back((ends.empty() ? 0 : ends.back()) + piece.triangles.size());
        const auto place = [&](std::uint64_t triangle) {
            const auto i =
                static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), triangle) - ends.begin());
            FacePiece again;
            const std::size_t offset =
                read_piece(text_, ranges_[i], rows_, layout_, again, triangle - (i == 0 ? 0 : ends[i - 1]));
            return fmt::format("line {}", line_at(text_, offset));
        };
        MeshFile file = make_mesh_file(join(pieces_, executor_), source_.name, 0, place, remarks_, executor_);
        progress_.finish();
        return file;
    }

  private:
    struct Failure {
        std::size_t offset;
        std::string text;
    };

    void read_lines(RowLayout layout) {
        const std::vector<std::size_t> cuts = cut_at_lines(text_, rows_.begin);
        const std::size_t count = cuts.size() - 1;
        start(layout, count);
        std::vector<std::uint64_t> lines(count);
        executor_.for_chunks(count, 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
            for (std::uint64_t i = begin; i < end; ++i)
                lines[i] = count_rows(text_.substr(cuts[i], cuts[i + 1] - cuts[i]), rows_.comment);
        });
        lines_ = 0;
        for (std::size_t i = 0; i < count; ++i) {
            ranges_[i] = {cuts[i], cuts[i + 1], lines_, rows_.rows};
            lines_ += lines[i];
        }
        executor_.for_chunks(count, 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
            for (std::uint64_t i = begin; i < end; ++i) {
                if (ranges_[i].first_row < rows_.rows)
                    read_piece(text_, ranges_[i], rows_, layout_, pieces_[i]);
                count_piece(pieces_[i], limits_);
                release(source_, source_.bytes.subspan(cuts[i], cuts[i + 1] - cuts[i]));
                progress_.add(cuts[i + 1] - cuts[i]);
            }
        });
        for (const FacePiece& piece : pieces_)
            if (const auto& fault = piece.fault) {
                fail(*fault);
                return;
            }
        if (lines_ < rows_.rows)
            fail_at_end(lines_, rows_.rows);
    }

    /// Only where a row has ended is it known where the next one begins, so this is a single walk.
    void read_words() {
        start(RowLayout::words, 0);
        const std::uint64_t all_rows = rows_.rows + rows_.more_rows;
        const char* const end = text_.data() + text_.size();
        RowWords words(text_, skip_blanks(text_.data() + rows_.begin, end), layout_);
        for (std::uint64_t row = 0; row < all_rows;) {
            executor_.check_cancelled();
            ranges_.push_back({words.offset(), text_.size(), row, all_rows});
            RowRange& range = ranges_.back();
            FacePiece& piece = pieces_.emplace_back();
            constexpr std::size_t piece_bytes = std::size_t{1} << 20;
            try {
                for (; row < all_rows && words.offset() - range.begin < piece_bytes; ++row)
                    rows_.read_row(row, words, piece);
            } catch (const TextFault& fault) {
                count_piece(piece, limits_); // it is given back with the others
                if (fault.offset == text_.size())
                    fail_at_end(row, all_rows);
                else
                    fail(fault);
                return;
            }
            range.last_row = row;
            count_piece(piece, limits_);
            release(source_, source_.bytes.subspan(range.begin, words.offset() - range.begin));
        }
        words.move_to(skip_blanks(text_.data() + words.offset(), end));
        if (words.offset() != text_.size())
            fail({words.offset(),
                  fmt::format("the end of the file after the {} rows of {}", all_rows, rows_.counted_where)});
    }

    void read_other_layouts() {
        const std::size_t first_odd_line = failure_->offset;
        read_words();
        if (!failure_ || lines_ != rows_.rows + rows_.more_rows)
            return;
        read_lines(RowLayout::lines);
        if (!failure_)
            remarks_.add(
                fmt::format("line {}: left out what the line has beyond the values of its row (this is "
                            "the first)",
                            line_at(text_, first_odd_line)));
    }

    void start(RowLayout layout, std::size_t pieces) {
        layout_ = layout;
        failure_.reset();
        for (const FacePiece& piece : pieces_)
            give_back_piece(piece, limits_);
        pieces_.clear();
        pieces_.resize(pieces);
        ranges_.assign(pieces, {});
    }

    void fail(const TextFault& fault) {
        failure_ = {fault.offset, found_instead(text_, fault.offset, fault.expected)};
    }

    void fail_at_end(std::uint64_t found, std::uint64_t expected) {
        failure_ = {
            text_.size(),
            fmt::format("line {}: the file ends after {} rows, expected {} by {} (it is cut off, or the "
                        "numbers there are wrong)",
                        line_at(text_, text_.size()), found, expected, rows_.counted_where)};
    }

    void tell_thin_faces() {
        std::uint64_t thin = 0;
        std::size_t first_thin = FacePiece::nowhere;
        for (const FacePiece& piece : pieces_) {
            thin += piece.thin_faces;
            first_thin = std::min(first_thin, piece.first_thin);
        }
        if (thin != 0)
            remarks_.add(
                fmt::format("line {}: left out {} {} of fewer than three corners (this is the first)",
                            line_at(text_, first_thin), thin, thin == 1 ? "face" : "faces"));
    }

    const ByteSource& source_;
    const FaceRows& rows_;
    Remarks& remarks_;
    ReadLimits& limits_;
    Executor executor_;
    ProgressMeter progress_;
    std::string_view text_;

    RowLayout layout_ = RowLayout::lines;
    std::vector<RowRange> ranges_; ///< of the pieces
    std::vector<FacePiece> pieces_;
    std::uint64_t lines_ = 0; ///< that hold a word
    std::optional<Failure> failure_;
};

} // namespace

MeshFile read_face_rows(const ByteSource& source, const FaceRows& rows, Remarks& remarks, ReadLimits& limits,
                        const Execution& execution) {
    return RowsReader(source, rows, remarks, limits, execution).run();
}

} // namespace lamella
