#pragma once

// Pieces of lines in cells, ordered cell by cell.

#include "lamella/contour/layer.hpp"
#include "lamella/core/point.hpp"

#include "core/layer_budget.hpp"
#include "scan/hatch_lines.hpp"

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

/// Pieces of lines, sorted by cells. Within a cell they are sorted by lines, in alternating directions.
/// O(pieces + c log c) for c cells.
class Islands {
  public:
    /// Memory of a piece and of its two points.
    static constexpr std::uint64_t bytes_of_piece = 56;

    /// Allocates memory for at most this many pieces. Throws Error{limit} if the pieces exceed the budget.
    /// `add` throws it if the cells do, or if there are more than 2^21.
    Islands(std::uint64_t pieces, const LayerBudget& budget);

    /// Makes later calls of `add` refer to these lines, which must outlive this object.
    void begin(const HatchLines& lines) { directions_.push_back({&lines, pieces_.size()}); }
    /// Adds a piece of line i. All lines of a cell must have the same direction.
    void add(Cell cell, std::size_t i, double from, double to) {
        const std::uint32_t number = number_of(cell);
        cells_[number].points += 2;
        pieces_.push_back({number, static_cast<std::uint32_t>(i), from, to});
    }

    /// Returns the points of the cells row by row, in alternating directions.
    [[nodiscard]] PointArray points_in_rows() &&;
    /// Returns the points of the cells in an order that depends on a seed and a layer.
    [[nodiscard]] PointArray points_shuffled(std::uint64_t seed, std::uint64_t layer) &&;

  private:
    static constexpr auto no_line = static_cast<std::uint32_t>(-1);

    struct Position {
        Cell cell;
        std::uint32_t after = 0;      ///< the cell that was looked up after this one, the last time
        std::size_t points = 0;       ///< number of points in this cell
        std::ptrdiff_t next = 0;      ///< index of its next point
        std::ptrdiff_t step = 1;      ///< from this index to that of the following point
        std::uint32_t line = no_line; ///< line of the last piece
        bool back = true;             ///< true if that line runs backwards
        std::ptrdiff_t line_begin = 0;
    };
    struct Piece {
        std::uint32_t cell; ///< its index
        std::uint32_t line;
        double from;
        double to;
    };
    struct Direction {
        const HatchLines* lines;
        std::size_t begin; ///< index of its first piece
    };
    std::uint32_t number_of(Cell cell);
    void make_room_for_cells();
    PointArray points();
    void put(const Piece& piece, const HatchLines& lines);
    void end_line(const Position& position);

    LayerBudget budget_; ///< for cells
    std::vector<Position> cells_;
    std::unordered_map<std::uint64_t, std::uint32_t> number_; ///< by row and column
    std::uint32_t last_ = 0;                                  ///< the cell that was looked up last
    std::vector<Piece> pieces_;
    std::vector<Direction> directions_;
    std::vector<Point2> points_;
};

} // namespace lamella
