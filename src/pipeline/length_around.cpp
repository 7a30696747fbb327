#include "pipeline/length_around.hpp"

#include "contour/distance.hpp"
#include "scan/hatch_lines.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

namespace {

struct HatchVector {
    Point2 from;
    Point2 way;
    double length;
};

double cross_of(const Point2& u, const Point2& v) noexcept {
    return u.x * v.y - u.y * v.x;
}
double dot_of(const Point2& u, const Point2& v) noexcept {
    return u.x * v.x + u.y * v.y;
}

using Intervals = std::vector<std::pair<double, double>>;

/// Sorts intervals, and unites those that touch.
void unite(Intervals& row) {
    std::sort(row.begin(), row.end());
    std::size_t kept = 0;
    for (std::size_t i = 1; i < row.size(); ++i) {
        if (row[i].first <= row[kept].second)
            row[kept].second = std::max(row[kept].second, row[i].second);
        else
            row[++kept] = row[i];
    }
    if (!row.empty())
        row.resize(kept + 1);
}

double length_of_all(const Intervals& row) noexcept {
    double sum = 0;
    for (const auto& [from, to] : row)
        sum += to - from;
    return sum;
}

double length_of_both(const Intervals& a, const Intervals& b) noexcept {
    double sum = 0;
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
        sum += std::max(0.0, std::min(a[i].second, b[j].second) - std::max(a[i].first, b[j].first));
        if (a[i].second < b[j].second)
            ++i;
        else
            ++j;
    }
    return sum;
}

/// Returns the length of the edges of the area filled by lines of about one direction. The lines form rows.
/// An edge is an end of a row, or a section where a row is covered and the next row is not.
double around_rows(const std::vector<HatchVector>& lines, double distance) {
    // Averaging cancels rotations of short lines by rounding.
    Point2 direction;
    for (const HatchVector& line : lines) {
        const double sign = dot_of(line.way, lines.front().way) < 0 ? -1 : 1;
        direction = {direction.x + sign * line.way.x, direction.y + sign * line.way.y};
    }
    const double norm = std::sqrt(dot_of(direction, direction));
    const LineFrame frame{{.cos = direction.x / norm, .sin = direction.y / norm}};
    struct Placed {
        double v;
        double from;
        double to;
    };
    std::vector<Placed> placed;
    for (const HatchVector& line : lines) {
        const Point2 middle{line.from.x + line.way.x / 2, line.from.y + line.way.y / 2};
        const double along = frame.along(middle);
        placed.push_back({frame.across(middle), along - line.length / 2, along + line.length / 2});
    }
    std::sort(placed.begin(), placed.end(), [](const Placed& a, const Placed& b) { return a.v < b.v; });
    double edges = 0;
    Intervals before;
    Intervals row;
    double at = placed.front().v;
    const auto end_row = [&] {
        unite(row);
        edges += static_cast<double>(2 * row.size()) * distance + length_of_all(before) + length_of_all(row) -
                 2 * length_of_both(before, row);
        before = std::exchange(row, {});
    };
    for (const Placed& line : placed) {
        if (line.v - at > distance / 2) {
            end_row();
            if (line.v - at > 1.5 * distance)
                end_row(); // an empty row
            at = line.v;
        }
        row.emplace_back(line.from, line.to);
    }
    end_row();
    return edges + length_of_all(before);
}

} // namespace

double length_around(std::span<const Point2> lines, double distance_mm) {
    std::vector<HatchVector> left;
    for (std::size_t i = 0; i + 1 < lines.size(); i += 2)
        if (const double length = distance(lines[i], lines[i + 1]); length > 0)
            left.push_back({lines[i], {lines[i + 1].x - lines[i].x, lines[i + 1].y - lines[i].y}, length});
    std::stable_sort(left.begin(), left.end(),
                     [](const HatchVector& a, const HatchVector& b) { return a.length > b.length; });
    double edges = 0;
    while (!left.empty()) {
        const HatchVector longest = left.front();
        constexpr double about_one_direction =
            0.3; // sine of the largest angle within one direction; those of a pattern differ by more
        std::vector<HatchVector> others;
        std::vector<HatchVector> alike;
        for (const HatchVector& line : left)
            (std::abs(cross_of(longest.way, line.way)) <= about_one_direction * longest.length * line.length
                 ? alike
                 : others)
                .push_back(line);
        edges += around_rows(alike, distance_mm);
        left = std::move(others);
    }
    return edges;
}

} // namespace lamella
