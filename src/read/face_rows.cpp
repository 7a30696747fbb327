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

/// Reads the rows of one piece, until the triangle with this number is there. Returns where it stopped.
std::size_t read_piece(std::string_view text, std::size_t begin, std::size_t end, std::uint64_t first_row,
                       const FaceRows& rows, FacePiece& piece,
                       std::uint64_t last_triangle = std::numeric_limits<std::uint64_t>::max()) {
    std::uint64_t row = first_row;
    std::size_t stopped = end;
    const std::string_view upto = text.substr(0, end);
    RowWords words(upto, text.data() + begin);
    try {
        for_rows(text.data() + begin, text.data() + end, rows.comment, [&](const char* at) -> const char* {
            if (row == rows.rows)
                return nullptr;
            words.move_to(at);
            rows.read_row(row++, words, piece);
            if (piece.triangles.size() > last_triangle) {
                stopped = static_cast<std::size_t>(at - text.data());
                return nullptr;
            }
            return words.skip_rest();
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

/// Skips blanks before the next word of the line.
inline void RowWords::to_word(std::string_view expected) {
    at_ = skip_spaces(at_, end_);
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
    const std::size_t begin = offset();
    const std::int64_t count = integer();
    if (count < 0)
        throw TextFault{begin, "how many corners the face has"};
    corners_.clear();
    for (std::int64_t i = 0; i < count; ++i) {
        const std::int64_t v = integer();
        corners_.push_back(v >= 0 && v < std::int64_t{FacePiece::no_vertex} ? static_cast<std::uint32_t>(v)
                                                                            : FacePiece::no_vertex);
    }
    piece.add_face(corners_, begin);
}

void RowWords::add_strips(FacePiece& piece) {
    const std::size_t begin = offset();
    const std::int64_t count = integer();
    if (count < 0)
        throw TextFault{begin, "how many numbers of vertices there are"};
    TriangleStrip strip;
    for (std::int64_t i = 0; i < count; ++i) {
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

const char* RowWords::skip_rest() {
    at_ = skip_to_line_end(at_, end_);
    return at_;
}

MeshFile read_face_rows(const ByteSource& source, const FaceRows& rows, Remarks& remarks, ReadLimits& limits,
                        const Execution& execution) {
    const std::string_view text(reinterpret_cast<const char*>(source.bytes.data()), source.bytes.size());
    const std::vector<std::size_t> cuts = cut_at_lines(text, rows.begin);
    std::vector<FacePiece> pieces(cuts.size() - 1);
    std::vector<std::uint64_t> first_row(pieces.size() + 1);
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, text.size());
    executor.for_chunks(pieces.size(), 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        for (std::uint64_t i = begin; i < end; ++i)
            first_row[i + 1] = count_rows(text.substr(cuts[i], cuts[i + 1] - cuts[i]), rows.comment);
    });
    for (std::size_t i = 1; i < first_row.size(); ++i)
        first_row[i] += first_row[i - 1];
    executor.for_chunks(pieces.size(), 1, [&](std::uint64_t begin, std::uint64_t end, unsigned) {
        for (std::uint64_t i = begin; i < end; ++i) {
            if (first_row[i] < rows.rows)
                read_piece(text, cuts[i], cuts[i + 1], first_row[i], rows, pieces[i]);
            count_piece(pieces[i], limits);
            progress.add(cuts[i + 1] - cuts[i]);
        }
    });

    std::uint64_t thin = 0;
    std::size_t first_thin = FacePiece::nowhere;
    std::vector<std::uint64_t> ends; // of the pieces, in triangles
    for (const FacePiece& piece : pieces) {
        if (const auto& fault = piece.fault)
            throw Error(ErrorKind::input, fmt::format("{}: {}", source.name,
                                                      found_instead(text, fault->offset, fault->expected)));
        thin += piece.thin_faces;
        first_thin = std::min(first_thin, piece.first_thin);
        ends.push_back((ends.empty() ? 0 : ends.back()) + piece.triangles.size());
    }
    if (first_row.back() < rows.rows)
        throw Error(
            ErrorKind::input,
            fmt::format("{}: line {}: the file ends after {} rows, expected {} by {} (it is cut off, or the "
                        "numbers there are wrong)",
                        source.name, line_at(text, text.size()), first_row.back(), rows.rows,
                        rows.counted_where));
    if (thin != 0)
        remarks.add(fmt::format("line {}: left out {} {} of fewer than three corners (this is the first)",
                                line_at(text, first_thin), thin, thin == 1 ? "face" : "faces"));
    const auto place = [&](std::uint64_t triangle) {
        const auto i =
            static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), triangle) - ends.begin());
        FacePiece again;
        const std::size_t offset = read_piece(text, cuts[i], cuts[i + 1], first_row[i], rows, again,
                                              triangle - (i == 0 ? 0 : ends[i - 1]));
        return fmt::format("line {}", line_at(text, offset));
    };
    MeshFile file = make_mesh_file(join(pieces, executor), source.name, 0, place, remarks, executor);
    progress.finish();
    return file;
}

} // namespace lamella
