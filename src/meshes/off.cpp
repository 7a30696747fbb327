#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "meshes/face_rows.hpp"
#include "meshes/mesh_readers.hpp"
#include "meshes/remarks.hpp"

#include <optional>
#include <string>

namespace lamella {

namespace {

/// Contents of the first word: [ST][C][N][4][n]OFF. Some programs write "off".
struct OffKind {
    bool homogeneous = false;   ///< each vertex has a fourth coordinate
    bool any_dimension = false; ///< the number of coordinates precedes the counts
    std::size_t word_size = 0;
};

std::optional<OffKind> kind_of(std::string_view word) {
    OffKind kind;
    kind.word_size = word.size();
    const auto take = [&](std::string_view prefix) {
        const bool taken = word.starts_with(prefix);
        word.remove_prefix(taken ? prefix.size() : 0);
        return taken;
    };
    take("ST");
    take("C");
    take("N");
    kind.homogeneous = take("4");
    kind.any_dimension = take("n");
    if (!take("OFF") && !take("off"))
        return std::nullopt;
    // The first count may follow without a blank: "OFF8 12 0".
    kind.word_size -= word.size();
    const bool only_digits = word.find_first_not_of("0123456789") == std::string_view::npos;
    if (!only_digits && word[0] != '#')
        return std::nullopt;
    return kind;
}

/// A cursor over the words of the header.
class OffHeader : public Words {
  public:
    explicit OffHeader(std::string_view text) : Words(text, after_byte_order_mark(text)) {}

    /// Returns the next word, across lines and comments; empty at the end.
    std::string_view peek() {
        skip_comments();
        return Words::peek();
    }

    std::uint64_t count(std::string_view expected) {
        std::string_view word = peek();
        word = word.substr(0, word.find('#')); // a comment may follow without a blank
        std::uint64_t value = 0;
        constexpr std::size_t most_digits = 18;
        if (word.empty() || word.size() > most_digits)
            throw TextFault{offset(), std::string(expected)};
        for (const char digit : word) {
            if (digit < '0' || digit > '9')
                throw TextFault{offset(), std::string(expected)};
            value = value * 10 + static_cast<std::uint64_t>(digit - '0');
        }
        move_to(position() + word.size());
        return value;
    }

    /// Returns whether there is another word on this line.
    [[nodiscard]] bool line_goes_on() { return skip_blanks_in_line() && *position() != '#'; }

    /// Returns whether the next line that is not a comment consists of one word, which a row never does.
    [[nodiscard]] bool next_line_is_one_word() const {
        OffHeader ahead = *this;
        ahead.skip_line();
        return !ahead.peek().empty() && (ahead.skip_word(), !ahead.line_goes_on());
    }
};

struct OffCounts {
    OffKind kind;
    std::uint64_t vertices = 0;
    std::uint64_t faces = 0;
    std::size_t end = 0;
};

OffCounts read_header(std::string_view text) {
    OffHeader header(text);
    OffCounts counts;
    const std::string_view first = header.peek();
    if (const auto kind = kind_of(first)) {
        counts.kind = *kind;
        header.move_to(header.position() + kind->word_size);
    }
    if (const std::string_view word = header.peek(); word == "BINARY" || word == "binary")
        throw TextFault{header.offset(), "a text (binary OFF is not read; save it as ASCII OFF or PLY)"};
    if (counts.kind.any_dimension) {
        const std::size_t location = (static_cast<void>(header.peek()), header.offset());
        constexpr const char* expected =
            "3, the number of coordinates; meshes of other dimensions are not read";
        if (header.count(expected) != 3)
            throw TextFault{location, expected};
    }
    counts.vertices = header.count("the numbers of vertices, faces and edges");
    counts.faces = header.count("the number of faces");
    // The number of edges is not needed, and some files omit it.
    if (header.line_goes_on() || header.next_line_is_one_word())
        static_cast<void>(header.count("the number of edges"));
    header.skip_line();
    counts.end = header.offset();
    return counts;
}

} // namespace

bool is_off(std::string_view text) {
    return kind_of(OffHeader(text).peek()).has_value();
}

MeshFile read_off(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    const std::string_view text = source.text();
    OffCounts counts;
    try {
        counts = read_header(text);
    } catch (const TextFault& fault) {
        refuse_text(source, fault);
    }
    Remarks remarks(source.name, options.strict);
    ReadLimits limits(source, options);
    FaceRows rows;
    rows.begin = counts.end;
    rows.rows = counts.vertices + counts.faces;
    rows.comment = '#';
    rows.counted_where = "the numbers of vertices and faces";
    rows.read_row = [&](std::uint64_t row, RowWords& words, FaceChunk& chunk) {
        if (row >= counts.vertices) {
            words.add_face(chunk);
            return;
        }
        const double x = words.coordinate();
        const double y = words.coordinate();
        const double z = words.coordinate();
        const double w = counts.kind.homogeneous ? words.coordinate() : 1;
        if (w == 1)
            chunk.vertices.push_back({x, y, z});
        else
            chunk.vertices.push_back({x / w + 0.0, y / w + 0.0, z / w + 0.0});
    };
    MeshFile file = read_face_rows(source, rows, remarks, limits, execution);
    file.warnings = remarks.take();
    return file;
}

} // namespace lamella
