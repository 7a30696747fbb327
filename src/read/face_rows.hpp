#pragma once

// Texts of rows: first the vertices, then the faces, as ASCII PLY and OFF have them.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"

#include "core/byte_source.hpp"
#include "read/face_mesh.hpp"
#include "read/read_limits.hpp"
#include "read/remarks.hpp"
#include "read/text_pieces.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// What ends a row.
enum class RowLayout {
    lines,       ///< the line, whatever else it holds
    exact_lines, ///< the line, which holds nothing else
    words        ///< its last word: line ends are blanks like others
};

/// The words of one row. Each function throws TextFault where the row has no such word.
class RowWords : Words {
  public:
    RowWords(std::string_view text, std::size_t from, RowLayout layout)
        : Words(text, from), layout_(layout) {}

    using Words::move_to;
    using Words::offset;

    [[nodiscard]] double coordinate();
    [[nodiscard]] std::int64_t integer();
    void skip_word();
    /// Skips a count and as many words.
    void skip_list();
    /// Adds a face to the piece: so many corners, then the number of a vertex for each, from 0 on.
    void add_face(FacePiece& piece);
    /// Takes a count and as many numbers of vertices: strips of triangles with a negative number between
    /// them.
    void add_strips(FacePiece& piece);

    /// Ends the row. Returns where the next one may begin.
    [[nodiscard]] const char* end_row();

  private:
    void to_word(std::string_view expected);
    std::int64_t count(std::string_view expected);
    bool take_triangle(FacePiece& piece);

    RowLayout layout_;
    std::vector<std::uint32_t> corners_;
};

struct FaceRows {
    std::size_t begin = 0;       ///< where the first row begins
    std::uint64_t rows = 0;      ///< how many are needed
    std::uint64_t more_rows = 0; ///< how many ought to follow
    char comment = '\0';         ///< lines that begin with it are no rows
    /// Whether rows may lie in any way across lines. `read_row` then takes all words of its row.
    bool any_lines = false;
    std::string counted_where; ///< where the numbers of rows stand, for errors: "the head"
    /// Reads row number `row` into the piece.
    std::function<void(std::uint64_t row, RowWords& words, FacePiece& piece)> read_row;
};

/// Reads the rows and makes a mesh file of them. Lines without a word are no rows.
///
/// Where each row has a line to itself, as in nearly all files, they are read in parallel, and lines beyond
/// those that were counted are left out with a remark. Where `any_lines` allows it, other texts are read word
/// by word on one thread, up to the end of the file; and if that fails, although there are as many lines as
/// rows, what a line has beyond its row is left out with a remark. Throws Error{input} naming the line.
[[nodiscard]] MeshFile read_face_rows(const ByteSource& source, const FaceRows& rows, Remarks& remarks,
                                      ReadLimits& limits, const Execution& execution);

} // namespace lamella
