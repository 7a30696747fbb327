#pragma once

// Texts of rows, one on each line: first the vertices, then the faces, as ASCII PLY and OFF have them.

#include "lamella/core/execution.hpp"
#include "lamella/read/mesh_file.hpp"

#include "container/byte_source.hpp"
#include "read/face_mesh.hpp"
#include "read/read_limits.hpp"
#include "read/remarks.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

/// The words of one row. Each function throws TextFault where the row has no such word.
class RowWords {
  public:
    RowWords(std::string_view text, const char* at)
        : begin_(text.data()), at_(at), end_(text.data() + text.size()) {}

    [[nodiscard]] double coordinate();
    [[nodiscard]] std::int64_t integer();
    void skip_word();
    /// Adds a face to the piece: so many corners, then the number of a vertex for each, from 0 on.
    void add_face(FacePiece& piece);
    /// Takes a count and as many numbers of vertices: strips of triangles with a negative number between
    /// them.
    void add_strips(FacePiece& piece);

    [[nodiscard]] std::size_t offset() const { return static_cast<std::size_t>(at_ - begin_); }
    void move_to(const char* at) { at_ = at; }
    /// Where the line ends.
    [[nodiscard]] const char* skip_rest();

  private:
    void to_word(std::string_view expected);
    bool take_triangle(FacePiece& piece);

    const char* begin_;
    const char* at_;
    const char* end_;
    std::vector<std::uint32_t> corners_;
};

struct FaceRows {
    std::size_t begin = 0;     ///< where the first row begins
    std::uint64_t rows = 0;    ///< how many there ought to be
    char comment = '\0';       ///< lines that begin with it are no rows
    std::string counted_where; ///< where that number stands, for errors: "the head"
    /// Reads row number `row` into the piece.
    std::function<void(std::uint64_t row, RowWords& words, FacePiece& piece)> read_row;
};

/// Reads the rows in parallel and makes a mesh file of them. Lines without a word are no rows; what follows
/// the last row is not looked at. Throws Error{input} naming the line.
[[nodiscard]] MeshFile read_face_rows(const ByteSource& source, const FaceRows& rows, Remarks& remarks,
                                      ReadLimits& limits, const Execution& execution);

} // namespace lamella
