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

HatchLines lines_in(const HatchArea& area, CosSin angle, double distance, double phase) {
    const auto lines_of = [&](const Layer& layer) {
        return HatchLines(layer, angle, distance, phase);
    };
    HatchLines lines = lines_of(area.within);
    if (area.also_within != nullptr)
        lines.intersect(lines_of(*area.also_within));
    for (const Layer* const other : area.without)
        lines.subtract(lines_of(*other));
    return lines;
}

bool is_long_enough(double from, double to, const HatchRule& rule) noexcept {
    return to > from && to - from >= rule.shortest;
}

std::vector<Point2> line_by_line(const HatchLines& lines, const HatchRule& rule) {
    std::vector<Point2> points;
    points.reserve(lines.total());
    for (std::size_t i = 0; i < lines.size(); ++i) {
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

// For numbers of cells, which are within 2^30, as check_cells made sure. (std::floor is a call.)
std::int32_t floor_of(double number) noexcept {
    const auto towards_zero = static_cast<std::int32_t>(number);
    return towards_zero - static_cast<std::int32_t>(towards_zero > number);
}
std::int32_t ceil_of(double number) noexcept {
    return -floor_of(-number);
}

/// From 0 up to below n.
template <std::int32_t n>
std::int32_t modulo(std::int32_t number) noexcept {
    return (number % n + n) % n;
}

// Stripes are cells in one row each. What a line has of a stripe may be too short, where it ends just beyond
// the border of two: then the neighbour is a little longer.
void cut_into_stripes(const HatchLines& lines, const HatchRule& rule, Islands& islands) {
    const double width = rule.cell;
    const double more = rule.overlap / 2;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::span<const double> ends = lines.ends(i);
        for (std::size_t k = 0; k < ends.size(); k += 2) {
            const double begin = ends[k];
            const double end = ends[k + 1];
            if (!is_long_enough(begin, end, rule))
                continue;
            std::int32_t first = floor_of(begin / width);
            std::int32_t last = std::max(first, ceil_of(end / width) - 1);
            if (first < last && (first + 1) * width - begin < rule.shortest)
                ++first;
            if (first < last && end - last * width < rule.shortest)
                --last;
            for (std::int32_t stripe = first; stripe <= last; ++stripe) {
                const double from = stripe == first ? begin : std::max(begin, stripe * width - more);
                const double to = stripe == last ? end : std::min(end, (stripe + 1) * width + more);
                islands.add({stripe, 0}, i, from, to);
            }
        }
    }
}

/// Of a line in a row of cells: how far it reaches to both sides of the middle of each.
struct Reach {
    double half;  ///< what lies over the neighbours included
    double cover; ///< what the cell itself asks for, so that nothing between the cells stays bare
};

/// What a line has of every n-th of the cells along it, one of which is number `one`: number k lies within
/// a half of pitch * (k + offset). Calls add(k, from, to) where that is long enough. A piece that is too
/// short because the cell ends there is made longer, beyond the border of the cell, where there is material.
template <std::int32_t n, class Add>
void cut_into_cells(std::span<const double> ends, double pitch, double offset, Reach reach, std::int32_t one,
                    const HatchRule& rule, const Add& add) {
    for (std::size_t k = 0; k < ends.size(); k += 2) {
        if (!is_long_enough(ends[k], ends[k + 1], rule))
            continue;
        const std::int32_t first = ceil_of((ends[k] - reach.half) / pitch - offset);
        const std::int32_t last = floor_of((ends[k + 1] + reach.half) / pitch - offset);
        for (std::int32_t cell = first + modulo<n>(one - first); cell <= last; cell += n) {
            const double middle = pitch * (cell + offset);
            double from = std::max(ends[k], middle - reach.half);
            double to = std::min(ends[k + 1], middle + reach.half);
            if (to - from < rule.shortest &&
                std::max(ends[k], middle - reach.cover) < std::min(ends[k + 1], middle + reach.cover)) {
                constexpr double rounding = 0x1p-40;
                const double length = rule.shortest + rounding * (rule.shortest + std::abs(middle));
                from = std::max(ends[k], std::min((from + to - length) / 2, ends[k + 1] - length));
                to = std::min(ends[k + 1], from + length);
            }
            if (is_long_enough(from, to, rule))
                add(cell, from, to);
        }
    }
}

/// How far beside a cell a line may lie, so that its half of the distance to the next one still reaches into
/// the cell: not one that only touches it but for rounding.
double beside(const HatchRule& rule) noexcept {
    constexpr double rounding = 1e-9;
    return rule.distance * (0.5 - rounding);
}

// Squares of one colour have lines along the frame, those of the other colour have them across: these are the
// squares of the first colour in the frame turned by a right angle. A line between two rows belongs to both
// where it is nearer to the border than half the overlap, or than half a distance: else a strip along the
// border would be left to nobody.
void cut_into_squares(const HatchLines& lines, unsigned turns, const HatchRule& rule, Islands& islands) {
    const Reach reach{(rule.cell + rule.overlap) / 2, rule.cell / 2};
    const double across = 0.5 + std::max(1.0, rule.overlap / rule.distance) * beside(rule) / rule.cell;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const double v = lines.v(i) / rule.cell - 0.5;
        for (std::int32_t row = floor_of(v - across) + 1; row <= floor_of(v + across); ++row)
            cut_into_cells<2>(
                lines.ends(i), rule.cell, 0.5, reach, row, rule,
                [&](std::int32_t column, double from, double to) {
                    islands.add(turns == 0 ? Cell{row, column} : Cell{column, -row - 1}, i, from, to);
                });
    }
}

// Hexagons stand on a corner, in rows along the frame: the one in row r and place q has its middle at u =
// cell * (q + r / 2) and v = cell * r * sqrt(3) / 2. Turned by a sixth of a turn, (q, r) comes to (-r, q +
// r), and the same rows lie along the frame that is turned so. Of three colours, (q - r) modulo 3, each has
// the lines of one of three directions; turned once, colour c comes to -c.
//
// Where the border is slanted, a line ends where that leaves the half of the distance beside it: so lines and
// their halves cover the hexagon up to its corners.
void cut_into_hexagons(const HatchLines& lines, unsigned turns, const HatchRule& rule, Islands& islands) {
    const double root = std::sqrt(3.0);
    const double pitch = rule.cell * root / 2;
    const double width = rule.cell + rule.overlap;
    const double farthest = std::max(width / root, rule.cell / root + beside(rule));
    const std::int32_t colour = turns == 0 ? 0 : 2; // before it is turned
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const double v = lines.v(i);
        for (std::int32_t row = ceil_of((v - farthest) / pitch); row <= floor_of((v + farthest) / pitch);
             ++row) {
            const double off = std::abs(v - row * pitch);
            const double cover =
                std::min(rule.cell / 2, rule.cell - root * std::max(0.0, off - beside(rule)));
            const double half = std::max(cover, std::min(width / 2, width - root * off));
            if (half <= 0)
                continue;
            cut_into_cells<3>(lines.ends(i), rule.cell, row / 2.0, {half, cover}, row + colour, rule,
                              [&](std::int32_t place, double from, double to) {
                                  std::int32_t q = place;
                                  std::int32_t r = row;
                                  for (unsigned k = 0; k < turns; ++k)
                                      q = -std::exchange(r, q + r);
                                  assert(modulo<3>(q - r) == static_cast<std::int32_t>(turns));
                                  islands.add({r, q + (r >> 1)}, i, from, to);
                              });
        }
    }
}

/// Throws where there would be too many cells.
void check_cells(const Layer& area, const HatchRule& rule) {
    const double reach = largest_coordinate(area.points.span()); // from the origin
    if (!(reach / rule.cell < 0x1p28))
        throw Error(ErrorKind::limit,
                    fmt::format("layer {}: stripes or islands of {:g} mm are too many up to {:.6g} "
                                "mm from the origin; the limit is 2^28 in a row",
                                area.index, rule.cell, reach));
}

void check_pieces(const HatchLines& lines, const Layer& area, const HatchRule& rule) {
    double length = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::span<const double> ends = lines.ends(i);
        for (std::size_t k = 0; k < ends.size(); k += 2)
            length += ends[k + 1] - ends[k];
    }
    if (!(length / rule.cell < 0x1p26))
        throw Error(ErrorKind::limit, fmt::format("layer {}: lines of {:.6g} mm in stripes or islands of "
                                                  "{:g} mm are too many; the limit is 2^26",
                                                  area.index, length, rule.cell));
}

/// Whether line i, if there is one, has a piece that is long enough between two places.
bool has_piece(const HatchLines& lines, std::int64_t i, double from, double to, const HatchRule& rule) {
    if (i < 0 || i >= static_cast<std::int64_t>(lines.size()))
        return false;
    const std::span<const double> ends = lines.ends(static_cast<std::size_t>(i));
    auto k =
        static_cast<std::size_t>(std::upper_bound(ends.begin(), ends.end(), from) - ends.begin()) / 2 * 2;
    for (; k < ends.size() && ends[k] <= to; k += 2)
        if (is_long_enough(ends[k], ends[k + 1], rule))
            return true;
    return false;
}

/// The area that pieces too short for lines stand for, where there is no line beside them.
double too_short(const HatchLines& lines, const HatchRule& rule) {
    double length = 0;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::span<const double> ends = lines.ends(i);
        for (std::size_t k = 0; k < ends.size(); k += 2) {
            if (is_long_enough(ends[k], ends[k + 1], rule))
                continue;
            const auto line = static_cast<std::int64_t>(i);
            bool beside = false;
            for (const std::int64_t other : {line - 1, line, line + 1})
                beside = beside ||
                         has_piece(lines, other, ends[k] - rule.distance, ends[k + 1] + rule.distance, rule);
            if (!beside)
                length += ends[k + 1] - ends[k];
        }
    }
    return length * rule.distance;
}

/// The area of what lies between two lines and has none beside it, as lines across these meet it.
double between_lines(const HatchArea& area, const HatchLines& lines, const HatchRule& rule) {
    const double apart = 5 * rule.distance;
    const CosSin angle = lines.frame().angle;
    const HatchLines across = lines_in(area, {-angle.sin, angle.cos}, apart, 0);
    double length = 0;
    for (std::size_t i = 0; i < across.size(); ++i) {
        const double u = -across.v(i);
        const std::span<const double> ends = across.ends(i);
        for (std::size_t k = 0; k < ends.size(); k += 2) {
            if (ends[k + 1] - ends[k] >= rule.distance)
                continue;
            const double number = std::ceil(ends[k] / rule.distance); // of the first line above
            if (number * rule.distance <= ends[k + 1])
                continue;
            const std::int64_t line = static_cast<std::int64_t>(number) - lines.first();
            if (!has_piece(lines, line - 1, u - rule.distance, u + rule.distance, rule) &&
                !has_piece(lines, line, u - rule.distance, u + rule.distance, rule))
                length += ends[k + 1] - ends[k];
        }
    }
    return length * apart;
}

/// Lines in several directions see what lies between those of one.
bool may_leave_bare(const HatchArea& area, const std::vector<HatchLines>& lines, const HatchRule& rule) {
    double bare = 0;
    for (const HatchLines& one : lines)
        bare += too_short(one, rule);
    if (lines.size() == 1)
        bare += between_lines(area, lines.front(), rule);
    return bare > rule.distance * rule.distance / 4;
}

} // namespace

std::vector<CosSin> line_angles(const HatchRule& rule, std::uint64_t layer) {
    const double turned = std::fmod(rule.turn_degrees, 360) * static_cast<double>(layer);
    const double degrees = std::fmod(rule.angle_degrees, 360) + std::fmod(turned, 360);
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

// A circle so wide has the nearest line, half a distance beside its middle at most, for `shortest`.
double surely_hatched(const HatchRule& rule) noexcept {
    return std::sqrt(rule.shortest * rule.shortest + rule.distance * rule.distance);
}

PointArray hatch(const HatchArea& area, const HatchRule& rule, std::uint64_t seed, bool* bare) {
    const bool one_by_one = rule.pattern == HatchPattern::lines || rule.pattern == HatchPattern::meander;
    if (!one_by_one)
        check_cells(area.within, rule);
    std::vector<HatchLines> lines; // in each direction
    for (const CosSin angle : line_angles(rule, area.within.index)) {
        lines.push_back(lines_in(area, angle, rule.distance, line_phase(rule.pattern)));
        if (!one_by_one)
            check_pieces(lines.back(), area.within, rule);
    }
    if (bare != nullptr)
        *bare = may_leave_bare(area, lines, rule);
    if (one_by_one)
        return PointArray(line_by_line(lines.front(), rule));
    const bool stripes = rule.pattern == HatchPattern::stripes;
    const bool squares = rule.pattern == HatchPattern::chessboard;
    Islands islands;
    for (unsigned turns = 0; turns < lines.size(); ++turns) {
        islands.begin(lines[turns]);
        if (stripes)
            cut_into_stripes(lines[turns], rule, islands);
        else if (squares)
            cut_into_squares(lines[turns], turns, rule, islands);
        else
            cut_into_hexagons(lines[turns], turns, rule, islands);
    }
    return stripes || rule.order == IslandOrder::rows
               ? std::move(islands).points_in_rows()
               : std::move(islands).points_shuffled(seed, area.within.index);
}

} // namespace lamella
