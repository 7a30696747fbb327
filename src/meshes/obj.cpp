#include "container/coordinate_text.hpp"
#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "container/text_position.hpp"
#include "core/executor.hpp"
#include "meshes/face_mesh.hpp"
#include "meshes/mesh_readers.hpp"
#include "meshes/remarks.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace lamella {

namespace {

using namespace std::string_view_literals;

/// Parses a chunk line by line.
class ObjLines : Words {
  public:
    ObjLines(std::string_view text, FaceChunk& chunk, std::uint64_t most_triangles)
        : Words(text, chunk.begin), chunk_(chunk), most_triangles_(most_triangles) {}

    void run() {
        try {
            while (next_line()) {
            }
        } catch (TextFault& fault) {
            chunk_.fault = std::move(fault);
        }
        chunk_.end = offset();
    }

  private:
    bool next_line() {
        skip_blanks();
        if (at_ == end_ || offset() >= chunk_.limit)
            return false;
        if (begins_with_keyword("f") || begins_with_keyword("fo")) // former name of "f"
            return face();
        if (begins_with_keyword("v")) {
            vertex();
            skip_line();
            return true;
        }
        other();
        // A backslash continues neither a comment nor a folder name. Other statements, such as the numbers of
        // a curve, may continue, but their second line does not begin with a keyword that is read.
        at_ = skip_to_line_end(at_, end_);
        return true;
    }

    [[nodiscard]] bool begins_with_keyword(std::string_view keyword) const {
        const auto left = static_cast<std::size_t>(end_ - at_);
        return left >= keyword.size() && std::equal(keyword.begin(), keyword.end(), at_) &&
               (left == keyword.size() || is_blank(at_[keyword.size()]) || goes_on(at_ + keyword.size()));
    }
    /// Returns whether a backslash ends the line here.
    [[nodiscard]] bool goes_on(const char* at) const {
        return *at == '\\' && at + 1 != end_ && is_line_end(at[1]);
    }

    void vertex() {
        ++at_;
        std::array<double, 3> p{};
        for (double& value : p) {
            to_word();
            if (at_ == end_ || is_line_end(*at_))
                throw TextFault{offset(), "the x, y and z of a vertex"};
            value = coordinate();
        }
        chunk_.vertices.push_back({p[0], p[1], p[2]});
    }

    /// Takes a coordinate. A backslash may follow it without a blank.
    double coordinate() {
        double value = 0;
        const char* stop = parse_coordinate(at_, end_, value);
        if (stop == nullptr) {
            const char* const last = at_ + peek().size() - 1;
            stop = goes_on(last) ? parse_coordinate(at_, last, value) : nullptr;
        }
        if (stop == nullptr)
            return take_coordinate(); // throws the error
        at_ = stop;
        return value + 0.0; // turns -0 into +0
    }

    bool face() {
        const std::size_t begin = offset();
        at_ += begins_with_keyword("f") ? 1 : 2;
        corners_.clear();
        bool relative = false;
        for (to_word(); at_ != end_ && !is_line_end(*at_) && *at_ != '#'; to_word())
            corners_.push_back(corner(relative));
        const std::uint64_t first = chunk_.triangles.size();
        chunk_.add_face(corners_, begin);
        if (relative)
            note_relative(first);
        if (chunk_.triangles.size() > most_triangles_) {
            at_ = begin_ + begin;
            return false;
        }
        skip_line();
        return true;
    }

    /// Takes V, V/VT, V//VN or V/VT/VN.
    std::uint32_t corner(bool& relative) {
        const char* const word = at_;
        const auto fail = [&]() -> std::uint32_t {
            throw TextFault{static_cast<std::size_t>(word - begin_),
                            "the number of a vertex, such as 7, 7/1 or 7//3"};
        };
        const bool backwards = *at_ == '-';
        if (backwards)
            ++at_;
        const char* const digits = at_;
        constexpr std::uint64_t too_large = std::uint64_t{1} << 33;
        std::uint64_t number = 0;
        for (; at_ != end_ && is_digit(*at_); ++at_)
            number = std::min(number * 10 + static_cast<unsigned char>(*at_ - '0'), too_large);
        if (at_ == digits)
            return fail();
        while (at_ != end_ && (*at_ == '/' || is_digit(*at_) || (*at_ == '-' && at_[-1] == '/')))
            ++at_;
        if (at_ != end_ && !is_blank(*at_) && *at_ != '\\')
            return fail();
        if (!backwards)
            return number - 1 < FaceChunk::no_vertex ? static_cast<std::uint32_t>(number - 1)
                                                     : FaceChunk::no_vertex;
        // The index is relative to the vertices so far, in this chunk or before it. Vertices more than 2^31
        // back cannot be addressed.
        relative = true;
        constexpr std::uint64_t furthest = std::uint64_t{1} << 31;
        relative_.resize(corners_.size() + 1, false);
        if (number == 0 || number > furthest)
            return FaceChunk::no_vertex;
        relative_[corners_.size()] = true;
        return static_cast<std::uint32_t>(chunk_.vertices.size() - number);
    }

    /// Notes which corners of the last face are relative to the first vertex of this chunk.
    void note_relative(std::uint64_t first_triangle) {
        relative_.resize(corners_.size(), false);
        for (std::uint64_t t = first_triangle; t < chunk_.triangles.size(); ++t) {
            const std::array<std::uint64_t, 3> locations{0, t - first_triangle + 1, t - first_triangle + 2};
            for (std::size_t k = 0; k < 3; ++k)
                if (relative_[locations[k]])
                    chunk_.relative.push_back(3 * t + k);
        }
        relative_.clear();
    }

    void other() {
        if (begins_with_keyword("o") && chunk_.name == nowhere)
            chunk_.name = offset() + 1;
        if (begins_with_keyword("surf") || begins_with_keyword("curv"))
            chunk_.free_form.note(offset());
    }

    static bool is_digit(char c) { return static_cast<unsigned char>(c - '0') < 10; }

    /// Skips blanks within the line, and a backslash at its end.
    void to_word() {
        for (;;) {
            at_ = skip_spaces(at_, end_);
            if (at_ == end_ || !goes_on(at_))
                return;
            at_ += at_[1] == '\r' && at_ + 2 != end_ && at_[2] == '\n' ? 3 : 2;
        }
    }

    /// Skips the rest of a vertex or a face, and the comment after it.
    void skip_line() {
        for (;;) {
            const char* const from = at_;
            at_ = skip_to_line_end(at_, end_);
            if (at_ == from || at_ == end_ || at_[-1] != '\\' || std::find(from, at_, '#') != at_)
                return;
            at_ += *at_ == '\r' && at_ + 1 != end_ && at_[1] == '\n' ? 2 : 1;
        }
    }

    FaceChunk& chunk_;
    std::uint64_t most_triangles_;
    std::vector<std::uint32_t> corners_;
    std::vector<bool> relative_; ///< the corners that are relative to the first vertex of this chunk
};

std::string first_line(std::string_view text, std::size_t offset) {
    constexpr std::size_t longest_name = 1000;
    const char* const end = text.data() + text.size();
    const char* const begin = skip_spaces(text.data() + offset, end);
    std::string_view line(begin, static_cast<std::size_t>(skip_to_line_end(begin, end) - begin));
    while (!line.empty() && is_blank(line.back()))
        line.remove_suffix(1);
    return printable(line, longest_name);
}

} // namespace

bool looks_like_obj(std::string_view text) {
    constexpr std::size_t enough = 65'536;
    text = text.substr(after_byte_order_mark(text), enough);
    Words words(text, 0);
    words.skip_comments();
    constexpr std::array keywords{"v"sv, "vt"sv, "vn"sv, "o"sv, "g"sv, "mtllib"sv, "usemtl"sv};
    return std::find(keywords.begin(), keywords.end(), words.peek()) != keywords.end();
}

MeshFile read_obj(const ByteSource& source, const MeshReadOptions& options, const Execution& execution) {
    const std::string_view text = source.text();
    ReadLimits limits(source, options);
    Executor executor(execution);
    ProgressMeter progress(execution, Stage::read, text.size());
    ChunkFormat<FaceChunk> format;
    format.parse = [text](FaceChunk& chunk, std::uint64_t most_triangles) {
        ObjLines(text, chunk, most_triangles).run();
    };
    format.find_cut = [text](std::size_t from, std::size_t limit) {
        return find_line(text, from, limit);
    };
    ChunkParser<FaceChunk> parser(source, after_byte_order_mark(text), std::move(format), executor, progress,
                                  face_chunks_ahead(executor));
    std::size_t name = nowhere;
    std::vector<FaceChunk> chunks = parser.rest([&](const FaceChunk& chunk) {
        count_chunk(chunk, limits);
        name = std::min(name, chunk.name);
    });
    if (chunks.back().fault)
        refuse_text(source, *chunks.back().fault);

    Remarks remarks(source.name, options.strict);
    MeshFile file = make_mesh_file(source, parser, chunks, 1, remarks, executor);
    if (name != nowhere)
        file.name = first_line(text, name);
    file.objects.front().name = file.name;
    file.warnings = remarks.take();
    progress.finish();
    return file;
}

} // namespace lamella
