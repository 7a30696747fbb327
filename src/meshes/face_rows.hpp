#pragma once

// Reads texts that consist of rows, first those of the vertices, then those of the faces, as in ASCII PLY and
// OFF files.

#include "lamella/core/execution.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include "container/read_limits.hpp"
#include "container/text_chunks.hpp"
#include "meshes/face_mesh.hpp"
#include "meshes/remarks.hpp"
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
    /// Takes a count, and skips as many words.
    void skip_list();
    /// Takes a count and as many vertex indices, from 0, and adds them to the chunk as a face.
    void add_face(FaceChunk& chunk);
    /// Takes a count and as many vertex indices, which are strips of triangles separated by a negative
    /// number.
    void add_strips(FaceChunk& chunk);

    /// Ends the row. Returns the earliest position at which the next one can begin.
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
    std::uint64_t more_rows = 0; ///< number of further rows in the file, which are not needed
    char comment = '\0';         ///< lines that begin with it are not rows
    /// True if a row may extend over several lines, and a line may contain several rows. `read_row` must then
    /// take all words of its row.
    bool any_lines = false;
    std::string counted_where; ///< part of the file that contains the numbers of rows, for errors
    /// Reads row number `row` into the chunk.
    std::function<void(std::uint64_t row, RowWords& words, FaceChunk& chunk)> read_row;
};

/// Reads the rows and makes them into a mesh file. Lines without a word are not rows.
///
/// If each row is on its own line, as in nearly all files, rows are read in parallel, and lines beyond the
/// stated number are skipped with a remark. Otherwise, if `any_lines` is true, the text is read word by word
/// on one thread up to its end. If that fails although there are as many lines as rows, each line is read as
/// a row, and excess words are skipped with a remark. Throws Error{input} with the line.
[[nodiscard]] MeshFile read_face_rows(const ByteSource& source, const FaceRows& rows, Remarks& remarks,
                                      ReadLimits& limits, const Execution& execution);

} // namespace lamella
