#include "scan/hatch.hpp"

#include "lamella/core/error.hpp"

#include "scan/hatch_lines.hpp"
#include "scan/islands.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Of the lines of a layer, to which a pattern adds.
double degrees_of(const HatchRule& rule, std::uint64_t layer) noexcept {
    const double turned = std::fmod(rule.turn_degrees, 360) * static_cast<double>(layer);
    return std::fmod(rule.angle_degrees, 360) + std::fmod(turned, 360);
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

std::int32_t whole(double number) noexcept {
    return static_cast<std::int32_t>(number); // within 2^24, as check_islands made sure
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
            double first = std::floor(begin / width);
            double last = std::max(first, std::ceil(end / width) - 1);
            if (first < last && (first + 1) * width - begin < rule.shortest)
                ++first;
            if (first < last && end - last * width < rule.shortest)
                --last;
            for (double stripe = first; stripe <= last; ++stripe) {
                const double from = stripe == first ? begin : std::max(begin, stripe * width - more);
                const double to = stripe == last ? end : std::min(end, (stripe + 1) * width + more);
                islands.add({whole(stripe), 0}, lines, i, from, to);
            }
        }
    }
}

/// What a line has of the cells along it: number k lies within `half` of pitch * (k + offset). Calls add(k,
/// from, to).
template <class Add>
void cut_into_cells(std::span<const double> ends, double pitch, double offset, double half, const Add& add) {
    for (std::size_t k = 0; k < ends.size(); k += 2) {
        const double first = std::ceil((ends[k] - half) / pitch - offset);
        const double last = std::floor((ends[k + 1] + half) / pitch - offset);
        for (double cell = first; cell <= last; ++cell) {
            const double middle = pitch * (cell + offset);
            add(whole(cell), std::max(ends[k], middle - half), std::min(ends[k + 1], middle + half));
        }
    }
}

// Of a line on the border of two rows counts the one above it. Squares of one colour have lines along the
// frame, those of the other colour have them across: these are the squares of the first colour in the frame
// turned by a right angle.
void cut_into_squares(const HatchLines& lines, unsigned turns, const HatchRule& rule, Islands& islands) {
    const double half = (rule.cell + rule.overlap) / 2;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const double v = lines.v(i) / rule.cell - 0.5;
        const double reach = half / rule.cell;
        for (double row = std::floor(v - reach) + 1; row <= std::floor(v + reach); ++row)
            cut_into_cells(
                lines.ends(i), rule.cell, 0.5, half, [&](std::int32_t column, double from, double to) {
                    if (((whole(row) ^ column) & 1) == 0 && is_long_enough(from, to, rule))
                        islands.add(turns == 0 ? Cell{whole(row), column} : Cell{column, -whole(row) - 1},
                                    lines, i, from, to);
                });
    }
}

// Hexagons stand on a corner, in rows along the frame: the one in row r and place q has its middle at u =
// cell * (q + r / 2) and v = cell * r * sqrt(3) / 2. Turned by a sixth of a turn, (q, r) comes to (-r, q +
// r), and the same rows lie along the frame that is turned so. Of three colours, (q - r) modulo 3, each has
// the lines of one of three directions.
void cut_into_hexagons(const HatchLines& lines, unsigned turns, const HatchRule& rule, Islands& islands) {
    const double root = std::sqrt(3.0);
    const double pitch = rule.cell * root / 2;
    const double width = rule.cell + rule.overlap;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const double v = lines.v(i);
        for (double row = std::ceil((v - width / root) / pitch);
             row <= std::floor((v + width / root) / pitch); ++row) {
            const double half = std::min(width / 2, width - root * std::abs(v - row * pitch));
            if (half <= 0)
                continue;
            cut_into_cells(
                lines.ends(i), rule.cell, row / 2, half, [&](std::int32_t place, double from, double to) {
                    std::int32_t q = place;
                    std::int32_t r = whole(row);
                    for (unsigned k = 0; k < turns; ++k)
                        q = -std::exchange(r, q + r);
                    const std::int32_t colour = ((q - r) % 3 + 3) % 3;
                    if (colour == static_cast<std::int32_t>(turns) && is_long_enough(from, to, rule))
                        islands.add({r, q + (r >> 1)}, lines, i, from, to);
                });
        }
    }
}

/// Throws where there would be too many cells.
void check_cells(const Layer& area, const HatchRule& rule) {
    double reach = 0; // from the origin, in any direction
    for (const Point2& p : area.points)
        reach = std::max({reach, std::abs(p.x), std::abs(p.y)});
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

} // namespace

PointArray hatch(const Layer& area, const HatchRule& rule, std::uint64_t seed) {
    const double degrees = degrees_of(rule, area.index);
    if (rule.pattern == HatchPattern::lines || rule.pattern == HatchPattern::meander)
        return PointArray(line_by_line(HatchLines(area, cos_sin_degrees(degrees), rule.distance), rule));
    check_cells(area, rule);
    Islands islands;
    const auto add_lines = [&](unsigned turns, double by, const auto& cut) {
        for (unsigned turn = 0; turn < turns; ++turn) {
            const HatchLines lines(area, cos_sin_degrees(degrees + turn * by), rule.distance);
            check_pieces(lines, area, rule);
            cut(lines, turn);
        }
    };
    switch (rule.pattern) {
    case HatchPattern::stripes:
        add_lines(1, 0, [&](const HatchLines& lines, unsigned) { cut_into_stripes(lines, rule, islands); });
        return islands.in_rows();
    case HatchPattern::chessboard:
        add_lines(2, 90, [&](const HatchLines& lines, unsigned turn) {
            cut_into_squares(lines, turn, rule, islands);
        });
        break;
    default:
        add_lines(3, 60, [&](const HatchLines& lines, unsigned turn) {
            cut_into_hexagons(lines, turn, rule, islands);
        });
    }
    return rule.order == IslandOrder::rows ? islands.in_rows() : islands.shuffled(seed, area.index);
}

} // namespace lamella
