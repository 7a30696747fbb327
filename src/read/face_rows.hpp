#pragma once

// Texts of rows, first the vertices, then the faces, as in ASCII PLY and OFF files.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"

#include "read/face_mesh.hpp"
#include "read/read_limits.hpp"
#include "read/remarks.hpp"
#include "read/text_chunks.hpp"
#include "system/byte_source.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// Specifies where a row ends.
enum class RowLayout {
    lines,       ///< at the end of its line, which may contain more words
    exact_lines, ///< at the end of its line, which contains nothing else
    words        ///< after its last word; line ends count as blanks
};

/// The words of one row. Each function throws TextFault if the row has no such word.
class RowWords : Words {
  public:
    RowWords(std::string_view text, std::size_t from, RowLayout layout)
        : Words(text, from), layout_(layout) {}

    using Words::move_to;
    using Words::offset;

    [[nodiscard]] double coordinate();
    [[nodiscard]] std::int64_t integer();
    void skip_word();
    /// Skips a count and this many words.
    void skip_list();
    /// Adds a face to the chunk: a count, then this many vertex indices from 0.
    void add_face(FaceChunk& chunk);
    /// Takes a count and this many vertex indices: strips of triangles, separated by a negative number.
    void add_strips(FaceChunk& chunk);

    /// Ends the row. Returns the earliest beginning of the next one.
    [[nodiscard]] const char* end_row();

  private:
    void to_word(std::string_view expected);
    std::int64_t count(std::string_view expected);
    bool take_triangle(FaceChunk& chunk);

    RowLayout layout_;
    std::vector<std::uint32_t> corners_;
};

struct FaceRows {
    std::size_t begin = 0;       ///< offset of the first row
    std::uint64_t rows = 0;      ///< number of rows needed
    std::uint64_t more_rows = 0; ///< number of rows expected after those
    char comment = '\0';         ///< lines that begin with it are not rows
    /// Rows may be divided among lines in any way. `read_row` then takes all words of its row.
    bool any_lines = false;
    std::string counted_where; ///< where the file states the numbers of rows, for errors
    /// Reads row number `row` into the chunk.
    std::function<void(std::uint64_t row, RowWords& words, FaceChunk& chunk)> read_row;
};

/// Reads the rows and makes them into a mesh file. Lines without a word are not rows.
///
/// If each row is on its own line, as in nearly all files, rows are read in parallel, and lines beyond the
/// stated number are skipped with a remark. Otherwise, if `any_lines` is true, the text is read word by word
/// on one thread up to its end; if that fails although there are as many lines as rows, excess words of a
/// line are skipped with a remark. Throws Error{input} with the line.
[[nodiscard]] MeshFile read_face_rows(const ByteSource& source, const FaceRows& rows, Remarks& remarks,
                                      ReadLimits& limits, const Execution& execution);

} // namespace lamella
