#pragma once

// Pieces of lines in cells, put in order cell by cell.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"

#include <compare>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace lamella {

/// A stripe, a square or a hexagon.
struct Cell {
    std::int32_t row;
    std::int32_t column;

    friend bool operator==(const Cell&, const Cell&) = default;
    friend auto operator<=>(const Cell&, const Cell&) = default;
};

/// Pieces of lines, cell by cell; in each cell line by line, back and forth.
///
/// The same pieces are told twice, in the same order: first they are counted, and once the order of the cells
/// is known each is put where it belongs. So no memory is touched but that of the result. O(pieces) and
/// O(c log c) for c cells.
class Islands {
  public:
    void count(Cell cell) { cells_[number_of(cell)].points += 2; }

    /// Cells row by row, back and forth.
    void order_in_rows();
    /// Cells in an order that a seed and a layer decide.
    void shuffle(std::uint64_t seed, std::uint64_t layer);

    /// `line`: other pieces of the cell with the same number lie on the same line.
    void put(Cell cell, std::size_t line, const Point2& from, const Point2& to);
    [[nodiscard]] PointArray points() &&;

  private:
    static constexpr auto no_line = static_cast<std::size_t>(-1);

    struct Place {
        Cell cell;
        std::uint32_t after = 0;    ///< the cell that was looked for after it, the last time
        std::size_t points = 0;     ///< in it
        std::ptrdiff_t next = 0;    ///< where its next point belongs
        std::ptrdiff_t step = 1;    ///< from there to the one after it
        std::size_t line = no_line; ///< of the last piece
        std::ptrdiff_t line_begin = 0;
        bool back = true; ///< whether that line is followed from its end
    };
    std::uint32_t number_of(Cell cell);
    void end_line(const Place& place);

    std::vector<Place> cells_;
    std::unordered_map<std::uint64_t, std::uint32_t> number_; ///< by row and column
    std::uint32_t last_ = 0;                                  ///< that was looked for
    std::vector<Point2> points_;
};

} // namespace lamella
