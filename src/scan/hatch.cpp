#include "scan/hatch.hpp"

#include "lamella/contour/rounding.hpp"
#include "lamella/core/error.hpp"

#include "scan/hatch_lines.hpp"
#include "scan/islands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

HatchLines lines_in(const HatchArea& area, CosSin angle, double distance, double phase,
                    const LayerBudget& budget) {
    HatchLines lines(area.within, angle, distance, phase, budget);
    const auto with_lines_of = [&](const Layer& layer, auto change) {
        const LayerBudget left = budget.without(lines.bytes());
        const HatchLines others(layer, angle, distance, phase, left);
        (lines.*change)(others, left.without(others.bytes()));
    };
    if (area.also_within != nullptr)
        with_lines_of(*area.also_within, &HatchLines::intersect);
    for (const Layer* const other : area.without)
        with_lines_of(*other, &HatchLines::subtract);
    return lines;
}

bool is_long_enough(double from, double to, const HatchRule& rule) noexcept {
    return to > from && to - from >= rule.shortest;
}

std::vector<Point2> line_by_line(const HatchLines& lines, const HatchRule& rule, const LayerBudget& budget) {
    budget.need(lines.total() / 2, 2 * sizeof(Point2), "hatch lines", "a larger `hatch.distance`");
    std::vector<Point2> points;
    points.reserve(lines.total());
    for (std::size_t i = 0; i < lines.size(); ++i) {
        budget.check();
        const auto begin = static_cast<std::ptrdiff_t>(points.size());
        const std::span<const double> ends = lines.ends(i);
        for (std::size_t k = 0; k < ends.size(); k += 2)
            if (is_long_enough(ends[k], ends[k + 1], rule)) {
                points.push_back(lines.frame().point(ends[k], lines.v(i)));
                points.push_back(lines.frame().point(ends[k + 1], lines.v(i)));
            }
        if (rule.pattern == HatchPattern::meander && lines.odd(i))
            std::reverse(points.begin() + begin, points.end());
    }
    return points;
}

// Rounds down to a cell index, which check_cells limits to 2^30. std::floor would be a function call.
std::int32_t floor_of(double number) noexcept {
    const auto towards_zero = static_cast<std::int32_t>(number);
    return towards_zero - static_cast<std::int32_t>(towards_zero > number);
}
std::int32_t ceil_of(double number) noexcept {
    return -floor_of(-number);
}

/// Returns a value from 0 to n - 1.
template <std::int32_t n>
std::int32_t modulo(std::int32_t number) noexcept {
    return (number % n + n) % n;
}

/// Calls visit(begin, end) for each piece of a line that is long enough.
template <class Visit>
void for_long_enough(std::span<const double> ends, const HatchRule& rule, const Visit& visit) {
    for (std::size_t k = 0; k < ends.size(); k += 2)
        if (is_long_enough(ends[k], ends[k + 1], rule))
            visit(ends[k], ends[k + 1]);
}

/// The cells that a piece of a line intersects: every n-th cell from the first to the last.
struct CellRange {
    std::int32_t first;
    std::int32_t last;

    [[nodiscard]] std::uint64_t size(std::int32_t n = 1) const noexcept {
        return last < first ? 0 : static_cast<std::uint64_t>((last - first) / n) + 1;
    }
};

/// Returns the stripes that get a piece of a line. If the line ends just beyond the border of two stripes,
/// its piece in the last one may be too short. Then the piece in the neighbouring stripe is extended instead.
CellRange stripes_of(double begin, double end, const HatchRule& rule) noexcept {
    const double width = rule.cell;
    CellRange stripes{floor_of(begin / width), 0};
    stripes.last = std::max(stripes.first, ceil_of(end / width) - 1);
    if (stripes.first < stripes.last && (stripes.first + 1) * width - begin < rule.shortest)
        ++stripes.first;
    if (stripes.first < stripes.last && end - stripes.last * width < rule.shortest)
        --stripes.last;
    return stripes;
}

// Each stripe is a cell in a row of its own.
void cut_into_stripes(const HatchLines& lines, const HatchRule& rule, const LayerBudget& budget,
                      Islands& islands) {
    const double width = rule.cell;
    const double more = rule.overlap / 2;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        budget.check();
        for_long_enough(lines.ends(i), rule, [&](double begin, double end) {
            const auto [first, last] = stripes_of(begin, end, rule);
            for (std::int32_t stripe = first; stripe <= last; ++stripe) {
                const double from = stripe == first ? begin : std::max(begin, stripe * width - more);
                const double to = stripe == last ? end : std::min(end, (stripe + 1) * width + more);
                islands.add({stripe, 0}, i, from, to);
            }
        });
    }
}

/// The extent of a line in a cell of a row, to both sides of the middle of the cell.
struct Reach {
    double half;  ///< including the overlap with neighbours
    double cover; ///< extent of the cell itself; less would leave gaps between cells
};

/// A row of cells along a line: cell k extends `reach` to both sides of pitch * (k + offset). The line has
/// pieces in every n-th cell; cell `one` is one of these cells.
struct CellRow {
    std::int32_t row;
    double pitch;
    double offset;
    Reach reach;
    std::int32_t one;

    template <std::int32_t n>
    [[nodiscard]] CellRange met_by(double begin, double end) const noexcept {
        const std::int32_t first = ceil_of((begin - reach.half) / pitch - offset);
        return {first + modulo<n>(one - first), floor_of((end + reach.half) / pitch - offset)};
    }
};

/// Calls add(k, from, to) for each piece of a line in the cells of a row that is long enough. A piece that is
/// too short because the cell ends is extended beyond the border of the cell into the material there.
template <std::int32_t n, class Add>
void cut_into_cells(std::span<const double> ends, const CellRow& cells, const HatchRule& rule,
                    const Add& add) {
    const Reach& reach = cells.reach;
    for_long_enough(ends, rule, [&](double begin, double end) {
        const auto [first, last] = cells.template met_by<n>(begin, end);
        for (std::int32_t cell = first; cell <= last; cell += n) {
            const double middle = cells.pitch * (cell + cells.offset);
            double from = std::max(begin, middle - reach.half);
            double to = std::min(end, middle + reach.half);
            if (to - from < rule.shortest &&
                std::max(begin, middle - reach.cover) < std::min(end, middle + reach.cover)) {
                constexpr double rounding = 0x1p-40;
                const double length = rule.shortest + rounding * (rule.shortest + std::abs(middle));
                from = std::max(begin, std::min((from + to - length) / 2, end - length));
                to = std::min(end, from + length);
            }
            if (is_long_enough(from, to, rule))
                add(cell, from, to);
        }
    });
}

/// Returns the largest distance from a cell at which a line still covers a part of the cell. A line covers
/// half of the line distance to both sides. The result is slightly reduced, so that a line does not count if
/// its strip only touches the cell.
double beside(const HatchRule& rule) noexcept {
    constexpr double rounding = 1e-9;
    return rule.distance * (0.5 - rounding);
}

// Squares of one colour have lines along the frame, and squares of the other colour have lines across it. In
// a frame rotated by a right angle, the second colour becomes the first. A line belongs to both adjacent rows
// if its distance from the border between them is less than half of the overlap or half of the line distance.
// Otherwise a strip along the border would belong to no square.
struct Squares {
    static constexpr std::int32_t colours = 2;

    /// Calls visit(i, cells) for each row that line i lies in.
    template <class Visit>
    static void for_rows(const HatchLines& lines, unsigned /*turns*/, const HatchRule& rule,
                         const Visit& visit) {
        const Reach reach{(rule.cell + rule.overlap) / 2, rule.cell / 2};
        const double across = half_across(rule);
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const double v = lines.v(i) / rule.cell - 0.5;
            for (std::int32_t row = floor_of(v - across) + 1; row <= floor_of(v + across); ++row)
                visit(i, CellRow{row, rule.cell, 0.5, reach, row});
        }
    }
    /// Returns the largest number of rows that a line lies in.
    static double most_rows(const HatchRule& rule) noexcept { return std::floor(2 * half_across(rule)) + 1; }
    static Cell cell(std::int32_t row, std::int32_t column, unsigned turns) noexcept {
        return turns == 0 ? Cell{row, column} : Cell{column, -row - 1};
    }

  private:
    /// Returns the largest distance of a line from the middle of its rows, in cells.
    static double half_across(const HatchRule& rule) noexcept {
        return 0.5 + std::max(1.0, rule.overlap / rule.distance) * beside(rule) / rule.cell;
    }
};

// Hexagons stand on a corner, in rows along the frame. The hexagon at index q in row r has its middle at u =
// cell * (q + r / 2) and v = cell * r * sqrt(3) / 2. A rotation by 60 degrees maps (q, r) to (-r, q + r), so
// the hexagons also form rows along the rotated frame. The colour of a hexagon is (q - r) modulo 3. Each
// colour has one of three directions of lines. A rotation maps colour c to -c.
//
// At a slanted border, a line ends where the whole strip that it covers has left the hexagon. So the strips
// cover the hexagon up to its corners.
struct Hexagons {
    static constexpr std::int32_t colours = 3;

    template <class Visit>
    static void for_rows(const HatchLines& lines, unsigned turns, const HatchRule& rule, const Visit& visit) {
        const double root = std::sqrt(3.0);
        const double pitch = rule.cell * root / 2;
        const double width = rule.cell + rule.overlap;
        const double far = farthest(rule);
        const std::int32_t colour = turns == 0 ? 0 : 2; // before the rotation
        for (std::size_t i = 0; i < lines.size(); ++i) {
            const double v = lines.v(i);
            for (std::int32_t row = ceil_of((v - far) / pitch); row <= floor_of((v + far) / pitch); ++row) {
                const double off = std::abs(v - row * pitch);
                const double cover =
                    std::min(rule.cell / 2, rule.cell - root * std::max(0.0, off - beside(rule)));
                const double half = std::max(cover, std::min(width / 2, width - root * off));
                if (half > 0)
                    visit(i, CellRow{row, rule.cell, row / 2.0, {half, cover}, row + colour});
            }
        }
    }
    static double most_rows(const HatchRule& rule) noexcept {
        return std::floor(2 * farthest(rule) / (rule.cell * std::sqrt(3.0) / 2)) + 1;
    }
    static Cell cell(std::int32_t row, std::int32_t position, unsigned turns) noexcept {
        std::int32_t q = position;
        std::int32_t r = row;
        for (unsigned k = 0; k < turns; ++k)
            q = -std::exchange(r, q + r);
        assert(modulo<3>(q - r) == static_cast<std::int32_t>(turns));
        return {r, q + (r >> 1)};
    }

  private:
    /// Returns the largest distance of a line from the middle of its rows.
    static double farthest(const HatchRule& rule) noexcept {
        const double root = std::sqrt(3.0);
        return std::max((rule.cell + rule.overlap) / root, rule.cell / root + beside(rule));
    }
};

/// Returns a quick upper bound of the number of pieces into which lines in all directions are cut.
std::uint64_t pieces_at_most(const std::vector<HatchLines>& lines, const HatchRule& rule) {
    double length = 0; // including the overlap of cells at both ends
    double count = 0;
    for (const HatchLines& one : lines)
        for (std::size_t i = 0; i < one.size(); ++i)
            for_long_enough(one.ends(i), rule, [&](double begin, double end) {
                length += end - begin + rule.cell + rule.overlap;
                ++count;
            });
    const double rows = rule.pattern == HatchPattern::stripes      ? 1
                        : rule.pattern == HatchPattern::chessboard ? Squares::most_rows(rule)
                                                                   : Hexagons::most_rows(rule);
    const double colours = static_cast<double>(lines.size());
    const double most = rows * (length / (colours * rule.cell) + count);
    return most < 0x1p62 ? static_cast<std::uint64_t>(std::ceil(most)) : std::uint64_t{1} << 62;
}

std::uint64_t stripe_pieces(const HatchLines& lines, const HatchRule& rule) {
    std::uint64_t pieces = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for_long_enough(lines.ends(i), rule,
                        [&](double begin, double end) { pieces += stripes_of(begin, end, rule).size(); });
    return pieces;
}

template <class Pattern>
std::uint64_t cell_pieces(const HatchLines& lines, unsigned turns, const HatchRule& rule) {
    std::uint64_t pieces = 0;
    Pattern::for_rows(lines, turns, rule, [&](std::size_t i, const CellRow& cells) {
        for_long_enough(lines.ends(i), rule, [&](double begin, double end) {
            pieces += cells.template met_by<Pattern::colours>(begin, end).size(Pattern::colours);
        });
    });
    return pieces;
}

template <class Pattern>
void cut_into(const HatchLines& lines, unsigned turns, const HatchRule& rule, const LayerBudget& budget,
              Islands& islands) {
    Pattern::for_rows(lines, turns, rule, [&](std::size_t i, const CellRow& cells) {
        budget.check();
        cut_into_cells<Pattern::colours>(
            lines.ends(i), cells, rule, [&](std::int32_t column, double from, double to) {
                islands.add(Pattern::cell(cells.row, column, turns), i, from, to);
            });
    });
}

/// Throws Error{limit} for too many cells.
void check_cells(const Layer& area, const HatchRule& rule, const LayerBudget& budget) {
    const double reach = largest_coordinate(area.points.span()); // from the origin
    if (!(reach / rule.cell < 0x1p28))
        throw Error(ErrorKind::limit,
                    fmt::format("{}: stripes or islands of {:g} mm are too many up to {:.6g} mm "
                                "from the origin; the limit is 2^28 in a row",
                                budget.layer(), rule.cell, reach));
}

/// Returns an upper bound of the number of pieces into which all lines are cut. It is nearly exact if the
/// quick upper bound exceeds a limit. Throws Error{limit} if there are too many.
std::uint64_t count_pieces(const std::vector<HatchLines>& lines, const HatchRule& rule,
                           const LayerBudget& budget) {
    constexpr std::uint64_t most = std::uint64_t{1} << 22;
    if (const std::uint64_t quick = pieces_at_most(lines, rule);
        quick <= std::min(most, budget.room(Islands::bytes_of_piece)))
        return quick;
    std::uint64_t pieces = 0;
    for (unsigned turns = 0; turns < lines.size(); ++turns)
        pieces += rule.pattern == HatchPattern::stripes ? stripe_pieces(lines[turns], rule)
                  : rule.pattern == HatchPattern::chessboard
                      ? cell_pieces<Squares>(lines[turns], turns, rule)
                      : cell_pieces<Hexagons>(lines[turns], turns, rule);
    if (pieces > most)
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: {} pieces of hatch lines in stripes or islands of {:g} mm are more than the "
                        "limit of {}; choose a larger `hatch.cell` or `hatch.distance`",
                        budget.layer(), pieces, rule.cell, most));
    return pieces;
}

} // namespace

std::vector<CosSin> line_angles(const HatchRule& rule, std::uint64_t layer) {
    const double rotated = std::fmod(rule.turn_degrees, 360) * static_cast<double>(layer);
    const double degrees = std::fmod(rule.angle_degrees, 360) + std::fmod(rotated, 360);
    switch (rule.pattern) {
    case HatchPattern::chessboard:
        return {cos_sin_degrees(degrees), cos_sin_degrees(degrees + 90)};
    case HatchPattern::hexagons:
        return {cos_sin_degrees(degrees), cos_sin_degrees(degrees + 60), cos_sin_degrees(degrees + 120)};
    default:
        return {cos_sin_degrees(degrees)};
    }
}

double line_phase(HatchPattern pattern) noexcept {
    return pattern == HatchPattern::chessboard ? 0.5 : 0;
}

// A line through a circle of this diameter is at least `shortest` long if it is at most half a line distance
// from the centre.
double surely_hatched(const HatchRule& rule) noexcept {
    return std::sqrt(rule.shortest * rule.shortest + rule.distance * rule.distance);
}

PointArray hatch(const HatchArea& area, const HatchRule& rule, std::uint64_t seed,
                 const LayerBudget& budget) {
    const bool one_by_one = rule.pattern == HatchPattern::lines || rule.pattern == HatchPattern::meander;
    if (!one_by_one)
        check_cells(area.within, rule, budget);
    LayerBudget left = budget;
    std::vector<HatchLines> lines; // one for each direction
    for (const CosSin angle : line_angles(rule, area.within.index)) {
        lines.push_back(lines_in(area, angle, rule.distance, line_phase(rule.pattern), left));
        left = left.without(lines.back().bytes());
    }
    if (one_by_one)
        return PointArray(line_by_line(lines.front(), rule, left));
    Islands islands(count_pieces(lines, rule, left), left);
    for (unsigned turns = 0; turns < lines.size(); ++turns) {
        islands.begin(lines[turns]);
        if (rule.pattern == HatchPattern::stripes)
            cut_into_stripes(lines[turns], rule, budget, islands);
        else if (rule.pattern == HatchPattern::chessboard)
            cut_into<Squares>(lines[turns], turns, rule, budget, islands);
        else
            cut_into<Hexagons>(lines[turns], turns, rule, budget, islands);
    }
    return rule.pattern == HatchPattern::stripes || rule.order == IslandOrder::rows
               ? std::move(islands).points_in_rows()
               : std::move(islands).points_shuffled(seed, area.within.index);
}

} // namespace lamella
