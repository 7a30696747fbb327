#pragma once

// Pieces of lines in cells, put in order cell by cell.

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

/// Pieces of lines, cell by cell; in each cell line by line, back and forth. O(pieces) and O(c log c) for c
/// cells.
class Islands {
  public:
    /// With its two points.
    static constexpr std::uint64_t bytes_of_piece = 56;

    /// For so many pieces at most. Throws Error{limit} where they, or later their cells, are more than the
    /// budget has room for, or these more than 2^21.
    Islands(std::uint64_t pieces, const LayerBudget& budget);

    /// What is added from here on are pieces of these lines, which are to outlive this.
    void begin(const HatchLines& lines) { directions_.push_back({&lines, pieces_.size()}); }
    /// A piece of line i; cells have lines of one direction.
    void add(Cell cell, std::size_t i, double from, double to) {
        const std::uint32_t number = number_of(cell);
        cells_[number].points += 2;
        pieces_.push_back({number, static_cast<std::uint32_t>(i), from, to});
    }

    /// Of cells row by row, back and forth.
    [[nodiscard]] PointArray points_in_rows() &&;
    /// Of cells in an order that a seed and a layer decide.
    [[nodiscard]] PointArray points_shuffled(std::uint64_t seed, std::uint64_t layer) &&;

  private:
    static constexpr auto no_line = static_cast<std::uint32_t>(-1);

    struct Position {
        Cell cell;
        std::uint32_t after = 0;      ///< the cell that was looked for after it, the last time
        std::size_t points = 0;       ///< in it
        std::ptrdiff_t next = 0;      ///< where its next point belongs
        std::ptrdiff_t step = 1;      ///< from there to the one after it
        std::uint32_t line = no_line; ///< of the last piece
        bool back = true;             ///< whether that line is followed from its end
        std::ptrdiff_t line_begin = 0;
    };
    struct Piece {
        std::uint32_t cell; ///< its number
        std::uint32_t line;
        double from;
        double to;
    };
    struct Direction {
        const HatchLines* lines;
        std::size_t begin; ///< of its pieces
    };
    std::uint32_t number_of(Cell cell);
    void make_room_for_cells();
    PointArray points();
    void put(const Piece& piece, const HatchLines& lines);
    void end_line(const Position& position);

    LayerBudget budget_; ///< for cells
    std::vector<Position> cells_;
    std::unordered_map<std::uint64_t, std::uint32_t> number_; ///< by row and column
    std::uint32_t last_ = 0;                                  ///< that was looked for
    std::vector<Piece> pieces_;
    std::vector<Direction> directions_;
    std::vector<Point2> points_;
};

} // namespace lamella
