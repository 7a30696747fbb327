#include "scan/islands.hpp"

#include "lamella/core/error.hpp"

#include "scan/seeded.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <numeric>
#include <utility>

namespace lamella {

namespace {

constexpr std::size_t most_cells = std::size_t{1} << 21;
/// Memory of an entry of the map of indices.
constexpr std::uint64_t node_bytes = 56;

} // namespace

Islands::Islands(std::uint64_t pieces, const LayerBudget& budget) {
    static_assert(sizeof(Piece) + 2 * sizeof(Point2) == bytes_of_piece);
    budget.need(pieces, bytes_of_piece, "hatch lines in stripes or islands",
                "a larger `hatch.distance` or `hatch.cell`");
    budget_ = budget.without(pieces * bytes_of_piece);
    pieces_.reserve(pieces);
}

void Islands::make_room_for_cells() {
    if (cells_.size() == most_cells)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: stripes or islands with lines are more than the limit of {}; choose larger "
                        "ones by `hatch.cell`",
                        budget_.layer(), most_cells));
    const std::size_t room = std::max<std::size_t>(64, 2 * cells_.capacity());
    constexpr std::uint64_t of_order = 16;
    budget_.need(room, sizeof(Position) + node_bytes + of_order, "stripes or islands",
                 "a larger `hatch.cell`");
    cells_.reserve(room);
}

// Lookups are fast because the order of cells along a line mostly equals that along the previous line.
std::uint32_t Islands::number_of(Cell cell) {
    if (!cells_.empty()) {
        const std::uint32_t guess = cells_[last_].after;
        if (cells_[guess].cell == cell)
            return last_ = guess;
    }
    const std::uint64_t key =
        std::uint64_t{static_cast<std::uint32_t>(cell.row)} << 32 | static_cast<std::uint32_t>(cell.column);
    if (cells_.size() == cells_.capacity())
        make_room_for_cells();
    const auto [found, added] = number_.try_emplace(key, static_cast<std::uint32_t>(cells_.size()));
    if (added)
        cells_.push_back({.cell = cell});
    cells_[last_].after = found->second;
    return last_ = found->second;
}

// Every other row is exposed from its end.
PointArray Islands::points_in_rows() && {
    std::vector<std::uint32_t> order(cells_.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
        const Cell& first = cells_[a].cell;
        const Cell& second = cells_[b].cell;
        const bool back = (first.row & 1) != 0 && first.row == second.row;
        return back ? second < first : first < second;
    });
    std::size_t total = 0;
    for (const std::uint32_t number : order) {
        Position& position = cells_[number];
        const bool back = (position.cell.row & 1) != 0;
        position.step = back ? -1 : 1;
        position.next = static_cast<std::ptrdiff_t>(back ? total + position.points - 1 : total);
        total += position.points;
    }
    assert(total == 2 * pieces_.size());
    return points();
}

PointArray Islands::points_shuffled(std::uint64_t seed, std::uint64_t layer) && {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    for (std::uint32_t number = 0; number < cells_.size(); ++number) {
        const Cell& cell = cells_[number].cell;
        const std::uint64_t lot = seeded(
            seed, {layer, static_cast<std::uint32_t>(cell.row), static_cast<std::uint32_t>(cell.column)});
        order.emplace_back(lot, number);
    }
    std::sort(order.begin(), order.end(), [this](const auto& a, const auto& b) {
        return a.first != b.first ? a.first < b.first : cells_[a.second].cell < cells_[b.second].cell;
    });
    std::size_t total = 0;
    for (const auto& [lot, number] : order) {
        cells_[number].next = static_cast<std::ptrdiff_t>(total);
        total += cells_[number].points;
    }
    assert(total == 2 * pieces_.size());
    return points();
}

PointArray Islands::points() {
    points_.resize(2 * pieces_.size());
    for (std::size_t d = 0; d < directions_.size(); ++d) {
        const std::size_t end = d + 1 < directions_.size() ? directions_[d + 1].begin : pieces_.size();
        for (std::size_t i = directions_[d].begin; i < end; ++i) {
            budget_.check();
            put(pieces_[i], *directions_[d].lines);
        }
    }
    for (const Position& position : cells_)
        end_line(position);
    return PointArray(std::move(points_));
}

void Islands::put(const Piece& piece, const HatchLines& lines) {
    Position& position = cells_[piece.cell];
    if (position.line != piece.line) {
        end_line(position);
        position.line = piece.line;
        position.line_begin = position.next;
        position.back = !position.back;
    }
    const double v = lines.v(piece.line);
    for (const double u : {piece.from, piece.to}) {
        assert(position.next >= 0 && static_cast<std::size_t>(position.next) < points_.size());
        points_[static_cast<std::size_t>(position.next)] = lines.frame().point(u, v);
        position.next += position.step;
    }
}

void Islands::end_line(const Position& position) {
    if (position.line == no_line || !position.back)
        return;
    const auto [begin, end] = position.step > 0 ? std::pair(position.line_begin, position.next)
                                                : std::pair(position.next + 1, position.line_begin + 1);
    std::reverse(points_.begin() + begin, points_.begin() + end);
}

} // namespace lamella
