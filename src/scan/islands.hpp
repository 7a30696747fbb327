#pragma once

// Pieces of lines in cells, put in order cell by cell.

#include "lamella/contour/layer.hpp"

#include "scan/hatch_lines.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace lamella {

/// A stripe, a square or a hexagon.
struct Cell {
    std::int32_t row;
    std::int32_t column;

    friend bool operator==(const Cell&, const Cell&) = default;
};

/// Collects pieces of lines. All pieces of one cell lie on lines in one direction.
class Islands {
  public:
    /// A piece of line `i` of those, from u to u. To be called in ascending order of lines, and along each.
    void add(Cell cell, const HatchLines& lines, std::size_t i, double from, double to);

    /// Row by row, back and forth, and in each cell line by line, back and forth. O(pieces).
    [[nodiscard]] PointArray in_rows() const;
    /// Cell by cell in an order that a seed and a layer decide; in each as above.
    [[nodiscard]] PointArray shuffled(std::uint64_t seed, std::uint64_t layer) const;

  private:
    struct Piece {
        Cell cell;
        std::size_t line;
        Point2 from;
        Point2 to;
    };
    /// The pieces of one cell: a run of what `by_cell` gives.
    struct Run {
        std::size_t begin;
        std::size_t end;
    };
    [[nodiscard]] std::vector<std::uint32_t> by_cell() const;
    [[nodiscard]] std::vector<Run> runs(const std::vector<std::uint32_t>& order) const;
    void put(const std::vector<std::uint32_t>& order, const Run& run, std::vector<Point2>& points) const;

    std::vector<Piece> pieces_;
};

} // namespace lamella
