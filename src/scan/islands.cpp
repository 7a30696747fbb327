#include "scan/islands.hpp"

#include "scan/seeded.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>
#include <utility>

namespace lamella {

namespace {

/// Sorts `order` by keys below `bound`, and leaves the order of equal ones. O(n) for each 11 bits of keys.
void sort_by_keys(std::vector<std::uint32_t>& order, const std::vector<std::uint64_t>& keys,
                  std::uint64_t bound) {
    constexpr unsigned digit_bits = 11;
    constexpr std::uint64_t digits = 1 << digit_bits;
    std::vector<std::uint32_t> next_order(order.size());
    for (unsigned shift = 0; bound >> shift != 0; shift += digit_bits) {
        std::array<std::uint32_t, digits + 1> begins{};
        const auto digit = [&](std::uint32_t i) {
            return (keys[i] >> shift) & (digits - 1);
        };
        for (const std::uint32_t i : order)
            ++begins[digit(i) + 1];
        std::partial_sum(begins.begin(), begins.end(), begins.begin());
        for (const std::uint32_t i : order)
            next_order[begins[digit(i)]++] = i;
        order.swap(next_order);
    }
}

} // namespace

void Islands::add(Cell cell, const HatchLines& lines, std::size_t i, double from, double to) {
    pieces_.push_back({cell, i, lines.frame().point(from, lines.v(i)), lines.frame().point(to, lines.v(i))});
}

std::vector<std::uint32_t> Islands::by_cell() const {
    std::vector<std::uint32_t> order(pieces_.size());
    std::iota(order.begin(), order.end(), 0U);
    if (pieces_.empty())
        return order;
    Cell least = pieces_.front().cell;
    Cell most = least;
    for (const Piece& piece : pieces_) {
        least = {std::min(least.row, piece.cell.row), std::min(least.column, piece.cell.column)};
        most = {std::max(most.row, piece.cell.row), std::max(most.column, piece.cell.column)};
    }
    const auto place = [](std::int32_t from, std::int32_t to) {
        return static_cast<std::uint64_t>(std::int64_t{to} - from);
    };
    const std::uint64_t columns = place(least.column, most.column) + 1;
    std::vector<std::uint64_t> keys(pieces_.size());
    for (std::size_t i = 0; i < keys.size(); ++i)
        keys[i] =
            place(least.row, pieces_[i].cell.row) * columns + place(least.column, pieces_[i].cell.column);
    sort_by_keys(order, keys, columns * (place(least.row, most.row) + 1) - 1);
    return order;
}

std::vector<Islands::Run> Islands::runs(const std::vector<std::uint32_t>& order) const {
    std::vector<Run> runs;
    for (std::size_t i = 0; i < order.size(); ++i) {
        if (i == 0 || pieces_[order[i]].cell != pieces_[order[i - 1]].cell)
            runs.push_back({i, i});
        ++runs.back().end;
    }
    return runs;
}

void Islands::put(const std::vector<std::uint32_t>& order, const Run& run,
                  std::vector<Point2>& points) const {
    bool back = false;
    for (std::size_t i = run.begin; i < run.end; back = !back) {
        const std::size_t line = pieces_[order[i]].line;
        const auto begin = static_cast<std::ptrdiff_t>(points.size());
        for (; i < run.end && pieces_[order[i]].line == line; ++i) {
            points.push_back(pieces_[order[i]].from);
            points.push_back(pieces_[order[i]].to);
        }
        if (back)
            std::reverse(points.begin() + begin, points.end());
    }
}

PointArray Islands::in_rows() const {
    const std::vector<std::uint32_t> order = by_cell();
    std::vector<Point2> points;
    points.reserve(2 * pieces_.size());
    std::ptrdiff_t row_begin = 0;
    const std::vector<Run> cells = runs(order);
    for (std::size_t i = 0; i < cells.size(); ++i) {
        put(order, cells[i], points);
        const std::int32_t row = pieces_[order[cells[i].begin]].cell.row;
        if (i + 1 < cells.size() && pieces_[order[cells[i + 1].begin]].cell.row == row)
            continue;
        if ((row & 1) != 0)
            std::reverse(points.begin() + row_begin, points.end());
        row_begin = static_cast<std::ptrdiff_t>(points.size());
    }
    return PointArray(std::move(points));
}

PointArray Islands::shuffled(std::uint64_t seed, std::uint64_t layer) const {
    const std::vector<std::uint32_t> order = by_cell();
    std::vector<std::pair<std::uint64_t, Run>> cells;
    for (const Run& run : runs(order)) {
        const Cell& cell = pieces_[order[run.begin]].cell;
        cells.push_back({seeded(seed, {layer, static_cast<std::uint32_t>(cell.row),
                                       static_cast<std::uint32_t>(cell.column)}),
                         run});
    }
    std::stable_sort(cells.begin(), cells.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<Point2> points;
    points.reserve(2 * pieces_.size());
    for (const auto& [number, run] : cells)
        put(order, run, points);
    return PointArray(std::move(points));
}

} // namespace lamella
