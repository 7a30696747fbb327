#include "meshes/stl_ascii.hpp"

#include "lamella/core/error.hpp"

#include "container/coordinate_text.hpp"
#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "container/text_position.hpp"
#include "core/counted.hpp"
#include "core/executor.hpp"
#include "core/let_go.hpp"
#include "core/lower_case.hpp"
#include "core/pages.hpp"
#include "meshes/remarks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

namespace lamella {

namespace {

/// Returns whether the word may begin a number, NaN or infinity. The keywords of a facet never do.
bool begins_like_number(std::string_view word) {
    return !word.empty() && (std::string_view("+-.0123456789").find(word[0]) != std::string_view::npos ||
                             begins_with_keyword(word, "nan") || begins_with_keyword(word, "inf"));
}

constexpr std::array<std::string_view, 9> keywords = {"outer", "loop",     "vertex", "endloop", "endfacet",
                                                      "facet", "endsolid", "solid",  "end"};

/// Returns whether the word is a keyword of a facet or a solid, and so not part of a normal.
bool begins_next_part(std::string_view word) {
    return std::any_of(keywords.begin(), keywords.end(),
                       [&](std::string_view keyword) { return matches(word, keyword); });
}

/// Returns whether a comment begins here, which some programs write up to the end of the line.
bool begins_comment(const Words& words) {
    if (words.at_end())
        return false;
    const char* const at = words.position();
    return *at == '#' || *at == ';' || *at == '!' ||
           (*at == '/' && at + 1 != words.text_end() && at[1] == '/');
}

/// Skips blanks and comments.
void to_next_word(Words& words) {
    for (words.skip_blanks(); begins_comment(words); words.skip_blanks())
        words.skip_line();
}

/// Takes the end of a loop, facet or solid if it is written as two words, such as "end facet".
bool take_two_words(Words& words, std::string_view of) {
    Words ahead = words;
    if (!ahead.take("end"))
        return false;
    ahead.skip_blanks();
    if (!ahead.take(of))
        return false;
    words = ahead;
    return true;
}

/// Returns whether the word "facet" that begins here begins a facet; otherwise it is part of a name.
bool facet_begins(Words words) {
    if (!words.take("facet"))
        return false;
    words.skip_blanks();
    if (!words.take("normal"))
        return matches(words.peek(), "outer");
    words.skip_blanks();
    if (begins_like_number(words.peek()))
        return true;
    constexpr int most_words = 8; // of a malformed normal
    for (int i = 0; i < most_words && !begins_next_part(words.peek()); ++i) {
        words.skip_word();
        words.skip_blanks();
    }
    return matches(words.peek(), "outer");
}

/// Reads the name of a solid, up to the end of the line or to a facet on the same line.
std::string_view take_name(Words& words) {
    words.skip_blanks_in_line();
    const char* first = words.position();
    const char* last = first;
    while (words.skip_blanks_in_line() && !facet_begins(words)) {
        words.skip_word();
        last = words.position();
    }
    return {first, static_cast<std::size_t>(last - first)};
}

/// Thrown if the text ends within a facet.
struct CutOff {};

/// A chunk of facets, and of solids that begin and end between them. `before` is 1 if the chunk begins within
/// a solid.
struct FacetChunk : TextChunk {
    std::vector<Triangle3f> triangles;
    std::uint64_t stored = 0; ///< number of facets, including those with a corner that is not finite
    Occurrences nonfinite;
    Occurrences odd_normals; ///< normals that are not numbers, or more than three numbers
    Occurrences two_words;   ///< "end facet" and the like
    Occurrences extra_words; ///< lines with words after "endfacet" and the like
    Occurrences unended;     ///< a "solid" before the previous one has ended
    Occurrences cut_off;     ///< the facet in which the text ended
    Occurrences garbage;     ///< text after the last "endsolid"
};

/// Parses one chunk.
class FacetParser {
  public:
    /// Stops before a facet that would exceed `most`.
    FacetParser(std::string_view text, FacetChunk& chunk, std::uint64_t most)
        : words_(text, chunk.begin), chunk_(chunk), most_(most), in_solid_(chunk.before != 0) {}

    void run() {
        try {
            while (next()) {
            }
        } catch (const CutOff&) {
            chunk_.cut_off.note(facet_);
            words_.move_to(words_.text_end());
        } catch (TextFault& fault) {
            chunk_.fault = std::move(fault);
        }
        chunk_.end = words_.offset();
        chunk_.after = in_solid_ ? 1 : 0;
    }

  private:
    /// Takes one facet, or the beginning or the end of a solid. Returns false at the end of the chunk.
    bool next() {
        to_next_word(words_);
        if (words_.at_end() || words_.offset() >= chunk_.limit)
            return false;
        const std::size_t here = words_.offset();
        if (chunk_.stored == most_ && matches(words_.peek(), "facet"))
            return false;
        if (words_.take("facet")) {
            facet_ = here;
            in_solid_ = true;
            parse_facet();
        } else if (words_.take("endsolid") || (in_solid_ && take_end("solid"))) {
            in_solid_ = false;
            take_name(words_);
        } else if (words_.take("solid")) {
            if (in_solid_)
                chunk_.unended.note(here);
            in_solid_ = true;
            take_name(words_);
        } else {
            return skip_rest();
        }
        return true;
    }

    /// Skips the text after the last solid. Throws if it contains facets, because these would be lost.
    bool skip_rest() {
        const std::size_t here = words_.offset();
        if (in_solid_) {
            if (ends_in("facet") || ends_in("endsolid") || ends_in_two_words("solid")) {
                words_.move_to(words_.text_end());
                return false; // the text was truncated in this word, and the solid has not ended
            }
            throw TextFault{here, "'facet' or 'endsolid'"};
        }
        for (Words rest = words_; !rest.at_end(); rest.skip_word(), rest.skip_blanks())
            if (facet_begins(rest))
                throw TextFault{here, "'solid' or the end of the file"};
        chunk_.garbage.note(here);
        words_.move_to(words_.text_end());
        return false;
    }

    void parse_facet() {
        to_next_word(words_);
        if (words_.take("normal"))
            skip_normal();
        else if (ends_in("normal"))
            throw CutOff{};
        expect("outer");
        expect("loop");
        skip_extra_words();
        Triangle3f triangle;
        for (Point3f& corner : triangle) {
            expect("vertex");
            corner.x = coordinate();
            corner.y = coordinate();
            corner.z = coordinate();
        }
        to_next_word(words_);
        if (words_.take("vertex"))
            throw TextFault{
                facet_,
                "this facet has more than three vertices, and only triangles can be read; triangulate "
                "the mesh first",
                false};
        expect_end("loop", "endloop");
        expect_end("facet", "endfacet");
        ++chunk_.stored;
        if (finite(triangle)) {
            chunk_.triangles.push_back(triangle);
        } else {
            chunk_.nonfinite.note(facet_);
        }
    }

    /// Skips the normal, which is not needed: up to three numbers, or other words on one line.
    void skip_normal() {
        bool odd = false;
        for (int i = 0;; ++i) {
            const bool same_line = words_.skip_blanks_in_line() && !begins_comment(words_);
            to_next_word(words_);
            const std::string_view word = words_.peek();
            if (is_last(word))
                throw CutOff{};
            if (i >= 3 || !begins_like_number(word)) {
                if (!same_line || begins_next_part(word))
                    break;
                odd = true;
            }
            words_.skip_word();
        }
        if (odd)
            chunk_.odd_normals.note(facet_);
    }

    /// Takes "endloop" or "end loop", and skips other words on its line.
    void expect_end(std::string_view of, std::string_view keyword) {
        to_next_word(words_);
        if (!words_.take(keyword) && !take_end(of)) {
            if (ends_in(keyword) || ends_in_two_words(of))
                throw CutOff{};
            throw TextFault{words_.offset(), fmt::format("'{}'", keyword)};
        }
        skip_extra_words();
    }

    /// Takes an end that is written as two words.
    bool take_end(std::string_view of) {
        const std::size_t here = words_.offset();
        if (!take_two_words(words_, of))
            return false;
        chunk_.two_words.note(here);
        return true;
    }

    /// Skips words on the same line that do not belong there.
    void skip_extra_words() {
        const auto is_extra = [&] {
            if (!words_.skip_blanks_in_line() || begins_comment(words_))
                return false;
            const std::string_view word = words_.peek();
            return !begins_next_part(word) &&
                   (!is_last(word) || std::none_of(keywords.begin(), keywords.end(),
                                                   [&](std::string_view k) { return ends_in(k); }));
        };
        if (!is_extra())
            return;
        chunk_.extra_words.note(words_.offset());
        do {
            words_.skip_word();
        } while (is_extra());
    }

    void expect(std::string_view keyword) {
        to_next_word(words_);
        if (words_.take(keyword))
            return;
        if (ends_in(keyword))
            throw CutOff{};
        throw TextFault{words_.offset(), fmt::format("'{}'", keyword)};
    }

    /// Returns whether the text ends here or within this keyword.
    [[nodiscard]] bool ends_in(std::string_view keyword) const {
        const auto left = static_cast<std::size_t>(words_.text_end() - words_.position());
        return left < keyword.size() && matches({words_.position(), left}, keyword.substr(0, left));
    }

    /// Returns whether the text ends within "end facet" and the like.
    [[nodiscard]] bool ends_in_two_words(std::string_view of) const {
        Words ahead = words_;
        if (!ahead.take("end"))
            return false;
        ahead.skip_blanks();
        const auto left = static_cast<std::size_t>(ahead.text_end() - ahead.position());
        return left < of.size() && matches({ahead.position(), left}, of.substr(0, left));
    }

    /// Returns whether the text ends with this word, which may then be cut off.
    [[nodiscard]] bool is_last(std::string_view word) const {
        return words_.position() + word.size() == words_.text_end();
    }

    float coordinate() {
        to_next_word(words_);
        const char* const first = words_.position();
        const char* const end = words_.text_end();
        float value = 0;
        const char* const stop = first == end ? nullptr : parse_coordinate(first, end, value);
        if (stop != nullptr && stop != end) {
            words_.move_to(stop);
            return value;
        }
        const std::string_view word = words_.peek();
        if (is_last(word))
            throw CutOff{}; // also after a number, because that may be truncated
        throw TextFault{words_.offset(), std::string(expected_instead(word))};
    }

    static bool finite(const Triangle3f& triangle) {
        return std::all_of(triangle.begin(), triangle.end(), [](const Point3f& p) {
            return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
        });
    }

    Words words_;
    FacetChunk& chunk_;
    std::uint64_t most_;
    bool in_solid_;
    std::size_t facet_ = nowhere;
};

/// Returns the offset of the first "facet" that follows an "endfacet" in [from, limit). This is a guess: both
/// words may belong to a name.
std::size_t find_cut(std::string_view text, std::size_t from, std::size_t limit) {
    Words words(text.substr(0, limit), from);
    words.skip_word(); // it may have begun before `from`
    while (words.skip_blanks(), !words.at_end()) {
        if (!words.take("endfacet")) {
            words.skip_word();
            continue;
        }
        words.skip_blanks();
        if (matches(words.peek(), "facet"))
            return words.offset();
    }
    return nowhere;
}

ChunkFormat<FacetChunk> format_of(std::string_view text) {
    ChunkFormat<FacetChunk> format;
    format.parse = [text](FacetChunk& chunk, std::uint64_t most) {
        FacetParser(text, chunk, most).run();
    };
    format.find_cut = [text](std::size_t from, std::size_t limit) {
        return find_cut(text, from, limit);
    };
    format.guess = [](std::vector<FacetChunk>& chunks) {
        for (std::size_t i = 1; i < chunks.size(); ++i)
            chunks[i].before = 1;
    };
    return format;
}

TriangleSoup join(std::vector<FacetChunk>& chunks, Executor& executor) {
    std::vector<std::size_t> first(chunks.size());
    std::size_t count = 0;
    for (std::size_t i = 0; i < chunks.size(); ++i) {
        first[i] = count;
        count += chunks[i].triangles.size();
    }
    const auto memory = std::make_shared<PageArray<Triangle3f>>(count);
    executor.for_chunks(chunks.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
        std::copy(chunks[i].triangles.begin(), chunks[i].triangles.end(), memory->data() + first[i]);
        let_go(chunks[i].triangles);
    });
    return {TriangleSoup::KnownFinite{}, memory, reinterpret_cast<const std::byte*>(memory->data()),
            sizeof(Triangle3f), count};
}

/// Adds up the counts of the chunks, which come in order.
void add(FacetChunk& sum, const FacetChunk& chunk) {
    sum.stored += chunk.stored;
    sum.nonfinite.add(chunk.nonfinite);
    sum.odd_normals.add(chunk.odd_normals);
    sum.two_words.add(chunk.two_words);
    sum.extra_words.add(chunk.extra_words);
    sum.unended.add(chunk.unended);
    sum.cut_off.add(chunk.cut_off);
    sum.garbage.add(chunk.garbage);
    sum.after = chunk.after;
    sum.fault = chunk.fault;
}

void count_triangles(const ChunkParser<FacetChunk>& parser, const FacetChunk& chunk, ReadLimits& limits) {
    const std::uint64_t left = limits.triangles_left();
    limits.add_triangles(chunk.stored, chunk.stored <= left
                                           ? std::string()
                                           : fmt::format("line {}", parser.line_of_triangle(chunk, left)));
}

/// Adds the warnings about the text as a whole.
MeshFile describe(const ByteSource& source, const FacetChunk& sum, const MeshReadOptions& options) {
    const std::string_view text = source.text();
    const auto line = [&](std::size_t offset) {
        return line_of(source, offset);
    };
    const auto fail = [&](const std::string& what) {
        throw Error(ErrorKind::input, fmt::format("{}: {}", source.name, what));
    };
    if (sum.fault)
        refuse_text(source, *sum.fault);
    if (sum.stored == 0)
        fail(sum.cut_off.count == 0
                 ? fmt::format("holds no triangle: an ASCII STL file without a facet, {} lines long",
                               line(text.size()))
                 : fmt::format("line {}: holds no triangle: the file ends within its first facet",
                               line(text.size())));

    Remarks remarks(source.name, options.strict);
    if (sum.nonfinite.count != 0)
        report_nonfinite(remarks, fmt::format("line {}", line(sum.nonfinite.first)), sum.nonfinite.count,
                         sum.stored);
    if (sum.odd_normals.count != 0)
        remarks.add(fmt::format("line {}: {} other words or more than three numbers, which were passed over "
                                "(this is the first); normals are not needed",
                                line(sum.odd_normals.first),
                                sum.odd_normals.count == 1
                                    ? "1 normal is"
                                    : fmt::format("{} normals are", sum.odd_normals.count)));
    if (sum.two_words.count != 0)
        remarks.add(fmt::format(
            "line {}: {} written as two words, such as 'end facet' for 'endfacet' (this is "
            "the first); taken as one",
            line(sum.two_words.first), counted(sum.two_words.count, "keyword is", "keywords are")));
    if (sum.extra_words.count != 0)
        remarks.add(fmt::format(
            "line {}: {} further words after 'outer loop', 'endloop' or 'endfacet' (this is "
            "the first); left out",
            line(sum.extra_words.first), counted(sum.extra_words.count, "line has", "lines have")));
    if (sum.unended.count != 0)
        remarks.add(
            fmt::format("line {}: a solid begins before the one above has ended; 'endsolid' is missing",
                        line(sum.unended.first)));
    if (sum.cut_off.count != 0)
        remarks.add(fmt::format("line {}: the file ends within this facet, which is left out; took the {} "
                                "triangles before it (the file is cut off)",
                                line(sum.cut_off.first), sum.stored));
    else if (sum.after != 0)
        remarks.add(fmt::format("line {}: the file ends without 'endsolid'; it may be cut off, took all {} "
                                "triangles",
                                line(text.size()), sum.stored));
    if (sum.garbage.count != 0)
        remarks.add(fmt::format("line {}: left out '{}' and what follows it, after the last 'endsolid'",
                                line(sum.garbage.first),
                                printable(Words(text, sum.garbage.first).peek(), 40)));

    MeshFile file;
    file.format = "stl-ascii";
    Words words(text, after_byte_order_mark(text));
    to_next_word(words);
    words.skip_word(); // "solid"
    constexpr std::size_t longest_name = 1000;
    file.name = printable(take_name(words), longest_name);
    file.objects.push_back({file.name, Mesh()});
    file.instances.push_back({});
    file.stored_triangles = sum.stored;
    file.nonfinite_triangles = sum.nonfinite.count;
    file.warnings = remarks.take();
    return file;
}

} // namespace

bool begins_with_solid(std::string_view text) {
    Words words(text, after_byte_order_mark(text));
    to_next_word(words);
    return words.take("solid");
}

bool is_stl_ascii(std::string_view text) {
    Words words(text, after_byte_order_mark(text));
    to_next_word(words);
    if (!words.take("solid"))
        return false;
    take_name(words);
    to_next_word(words);
    return matches(words.peek(), "facet") || matches(words.peek(), "endsolid") ||
           take_two_words(words, "solid");
}

MeshFile read_stl_ascii(const ByteSource& source, const MeshReadOptions& options,
                        const Execution& execution) {
    ReadLimits limits(source, options);
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, source.bytes.size());
    ChunkParser<FacetChunk> parser(source, after_byte_order_mark(source.text()), format_of(source.text()),
                                   executor, progress);
    FacetChunk sum;
    std::vector<FacetChunk> chunks = parser.rest([&](const FacetChunk& chunk) {
        count_triangles(parser, chunk, limits);
        limits.add_bytes_at(chunk.triangles.size() * sizeof(Triangle3f), at_byte(chunk.end));
        add(sum, chunk);
    });
    progress.finish();
    MeshFile file = describe(source, sum, options);
    file.objects.front().mesh = Mesh(join(chunks, executor));
    return file;
}

MeshFile stream_stl_ascii(const ByteSource& source, const TriangleSink& sink, const MeshReadOptions& options,
                          const Execution& execution) {
    ReadLimits limits(source, options);
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, source.bytes.size());
    ChunkParser<FacetChunk> parser(source, after_byte_order_mark(source.text()), format_of(source.text()),
                                   executor, progress);
    FacetChunk sum;
    std::uint64_t batches = 0;
    while (!parser.done()) {
        std::vector<FacetChunk> chunks = parser.next();
        for (const FacetChunk& chunk : chunks) {
            add(sum, chunk);
            count_triangles(parser, chunk, limits);
        }
        executor.for_chunks(chunks.size(), 1, [&](std::uint64_t i, std::uint64_t, unsigned) {
            if (!chunks[i].triangles.empty())
                sink(TriangleSoup(std::move(chunks[i].triangles)), batches + i);
        });
        batches += chunks.size();
    }
    progress.finish();
    return describe(source, sum, options);
}

} // namespace lamella
