// Measures how the cost of layer steps grows for layers that are designed to be slow. Each kind of layer has
// four sizes, each twice the one before; the growth is the power of the number of points that fits the times
// (n log n is about 1.1, a square 2). Checks: the number of crossings is that of the design; simplified
// contours keep within the tolerance and do not cross; filled layers have no crossings and do not change when
// filled again; of nested rings the largest is kept and hatched.

#include "experiment.hpp"

#include <fmt/format.h>
#include <lamella/formats.hpp>
#include <lamella/polygon/compare.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iostream>
#include <numbers>

namespace lamella::bench {

namespace {

using Contour = std::vector<Point2>;

Layer layer_of(const std::vector<Contour>& rings, const std::vector<Contour>& chains = {}) {
    LayerBuilder builder;
    for (const auto* contours : {&rings, &chains})
        for (const Contour& contour : *contours)
            builder.add_contour(contour, contours == &rings);
    return builder.finish(0, 0.5, 0, 1);
}

Point2 polar(double radius, double angle) {
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

constexpr double turn = 2 * std::numbers::pi;

/// Long segments that fan out by a factor of a hundred; each crosses one neighbour.
Layer narrow_fan(int n) {
    std::vector<Contour> lines;
    for (int i = 0; i < n; ++i)
        lines.push_back({{0, 1.0 * i / n}, {100, 100.0 * (i + (i % 2 == 0 ? 0.6 : -0.6)) / n}});
    return layer_of({}, lines);
}

/// The same fan of dashes; neighbours cross in the first ones.
Layer dashed_fan(int n) {
    std::vector<Contour> lines;
    for (int i = 0; i < n / 3; ++i) {
        const double from = 3.0 * i / n;
        const double to = 300 * (i + (i % 2 == 0 ? 0.6 : -0.6)) / n;
        const auto at = [&](double share) {
            return Point2{100 * share, from + share * (to - from)};
        };
        for (const double begin : {0.0, 0.34, 0.67})
            lines.push_back({at(begin), at(begin + 0.32)});
    }
    return layer_of({}, lines);
}

/// The same fan in all directions.
Layer round_fan(int n) {
    std::vector<Contour> lines;
    for (int i = 0; i < n; ++i)
        lines.push_back({polar(1, turn * i / n), polar(100, turn * (i + (i % 2 == 0 ? 0.6 : -0.6)) / n)});
    return layer_of({}, lines);
}

/// Oblique walls, each crossing one neighbour, and a line through all of them.
Layer walls_and_stray(int n) {
    std::vector<Contour> lines;
    for (int i = 0; i < n - 1; ++i)
        lines.push_back({{4.0 * i, 0}, {4.0 * n + 4.0 * i + (i % 2 == 0 ? 3 : -3), 4.0 * n}});
    lines.push_back({{-1, 2.0 * n + 1}, {8.0 * n, 2.0 * n + 2}});
    return layer_of({}, lines);
}

/// A star whose spikes all return to one point.
Layer star(int n) {
    Contour ring;
    for (int i = 0; i < n / 2; ++i) {
        ring.push_back({0, 0});
        ring.push_back(polar(100, turn * i / (n / 2)));
    }
    return layer_of({ring});
}

/// A wall along a spiral; its turns are three times its thickness apart.
Layer spiral_wall(int n, double turns) {
    Contour ring;
    Contour back;
    for (int i = 0; i < n / 2; ++i) {
        const double share = 2.0 * i / n;
        ring.push_back(polar(1 + 100 * share, turn * turns * share));
        back.push_back(polar(1 + 100 * share + 25 / turns, turn * turns * share));
    }
    ring.insert(ring.end(), back.rbegin(), back.rend());
    return layer_of({ring});
}

Layer zigzag(int n) {
    Contour chain;
    for (int i = 0; i < n; ++i)
        chain.push_back({1.0 * i, (i % 2 == 0 ? 1.0 : -1.0) * (n - i)});
    return layer_of({}, {chain});
}

Layer comb(int n) {
    Contour ring;
    for (int i = 0; i < n / 2; ++i) {
        ring.push_back({1.0 * i, 0});
        ring.push_back({i + 0.5, 1.0 * n});
    }
    ring.push_back({n / 2.0, -1});
    return layer_of({ring});
}

/// A plate with round holes and its copy, moved by half a pitch, as in `layer_steps`.
Layer plate_over_its_copy(int n) {
    constexpr int corners = 64;
    const int side = static_cast<int>(std::sqrt(n / (2.0 * corners)));
    std::vector<Contour> rings;
    for (const double by : {0.0, 0.5}) {
        rings.push_back({{by, by}, {side + by, by}, {side + by, side + by}, {by, side + by}});
        for (int i = 0; i < side * side; ++i) {
            Contour& hole = rings.emplace_back();
            for (int k = 0; k < corners; ++k) {
                const Point2 p = polar(0.4, -turn * k / corners);
                hole.push_back({p.x + by + 0.5 + i % side, p.y + by + 0.5 + i / side});
            }
        }
    }
    return layer_of(rings);
}

/// Discs in a row, each covering half of the next: all are connected.
Layer row_of_discs(int n) {
    constexpr int corners = 16;
    std::vector<Contour> rings;
    for (int i = 0; i < n / corners; ++i) {
        Contour& ring = rings.emplace_back();
        for (int k = 0; k < corners; ++k) {
            const Point2 p = polar(1, turn * k / corners + 1e-3 * i);
            ring.push_back({p.x + i, p.y});
        }
    }
    return layer_of(rings);
}

/// Slivers that all touch in one point, each as wide as the gap to the next.
Layer slivers(int n) {
    std::vector<Contour> rings;
    for (int i = 0; i < n / 3; ++i)
        rings.push_back({{0, 0}, polar(100, 3 * turn * i / n), polar(100, 3 * turn * (i + 0.5) / n)});
    return layer_of(rings);
}

/// Long parallel thin walls whose corners are displaced by up to 1e-5 times `off`.
Layer fins(int n, double off) {
    std::vector<Contour> rings;
    for (int i = 0; i < n / 4; ++i) {
        const double x = i + 1e-5 * off * std::sin(i);
        rings.push_back({{x, 0}, {x + 0.5, 0}, {x + 0.5, 1.0 * n}, {x, 1.0 * n}});
    }
    return layer_of(rings);
}

/// Small nested rings at one location in a large frame.
Layer nest(int n) {
    std::vector<Contour> rings{{{-1000, -1000}, {1000, -1000}, {1000, 1000}, {-1000, 1000}}};
    for (int i = 0; i < n / 8; ++i) {
        Contour& ring = rings.emplace_back();
        for (int k = 0; k < 8; ++k)
            ring.push_back(polar(8.0 * (i + 1) / n, (i % 2 == 0 ? -turn : turn) * k / 8));
    }
    return layer_of(rings);
}

/// Nested rings, all counter-clockwise, or every other one a hole.
Layer concentric(int n, bool holes) {
    constexpr int corners = 8;
    const int count = n / corners;
    std::vector<Contour> rings;
    for (int i = 0; i < count; ++i) {
        Contour& ring = rings.emplace_back();
        const bool hole = holes && (count - i) % 2 == 0;
        for (int k = 0; k < corners; ++k)
            ring.push_back(polar(100.0 * (i + 1) / count, (hole ? -turn : turn) * k / corners));
    }
    return layer_of(rings);
}

/// Nested rectangles whose lower sides are on one line, rotated by an angle.
Layer nested_on_a_line(int n, double angle, bool holes) {
    const int count = n / 4;
    std::vector<Contour> rings;
    for (int i = 1; i <= count; ++i) {
        const double r = 100.0 * i / count;
        Contour& ring = rings.emplace_back();
        for (const Point2& p : {Point2{-r, 0}, Point2{r, 0}, Point2{r, r}, Point2{-r, r}})
            ring.push_back({p.x * std::cos(angle) - p.y * std::sin(angle),
                            p.x * std::sin(angle) + p.y * std::cos(angle)});
        if (holes && (count - i) % 2 != 0)
            std::reverse(ring.begin(), ring.end());
    }
    return layer_of(rings);
}

/// Nested kites that share one corner.
Layer nested_at_an_end(int n, bool left, bool holes = false) {
    const int count = n / 4;
    std::vector<Contour> rings;
    for (int i = 1; i <= count; ++i) {
        const double r = (left ? 50.0 : -50.0) * i / count;
        const double h = r * i / count;
        rings.push_back({{0, 0}, {r, -h}, {2 * r, 0}, {r, h}});
        if (holes && (count - i) % 2 != 0)
            std::reverse(rings.back().begin(), rings.back().end());
    }
    return layer_of(rings);
}

/// Octagons around one another that touch in one point.
Layer nested_at_a_point(int n) {
    constexpr int corners = 8;
    const int count = n / corners;
    std::vector<Contour> rings;
    for (int i = 1; i <= count; ++i) {
        const double radius = 50.0 * i / count;
        Contour& ring = rings.emplace_back();
        for (int k = 0; k < corners; ++k) {
            const Point2 p = polar(radius, turn * k / corners);
            ring.push_back({p.x - radius, p.y});
        }
    }
    return layer_of(rings);
}

/// Kites side by side around one point, with half of the angle between them free.
Layer petals(int n) {
    const int count = n / 4;
    std::vector<Contour> rings;
    for (int i = 0; i < count; ++i) {
        const double angle = turn * i / count;
        const double half = turn / count / 4;
        rings.push_back({{0, 0}, polar(60, angle - half), polar(100, angle), polar(60, angle + half)});
    }
    return layer_of(rings);
}

/// Rings without area, stacked in a body, or all beginning at one point.
Layer flat_rings(int n, bool in_a_body) {
    std::vector<Contour> rings;
    if (in_a_body)
        rings.push_back({{-10, -10}, {110, -10}, {110, 110}, {-10, 110}});
    for (int i = 1; i <= n / 3; ++i) {
        const double y = in_a_body ? 300.0 * i / n : 0;
        const double x = in_a_body ? 100 : 300.0 * i / n;
        rings.push_back({{0, y}, {x, y}, {x / 2, y}});
    }
    return layer_of(rings);
}

/// Hooks in a column: all chains begin and end at the same x, and each ends closest to the beginning of the
/// next one.
Layer column_of_hooks(int n) {
    std::vector<Contour> chains;
    for (int i = 0; i < n / 3; ++i)
        chains.push_back({{0, 1.0 * i}, {-1, i + 0.3}, {0, i + 0.6}});
    return layer_of({}, chains);
}

/// Time in seconds, and whether the result is right.
struct Timed {
    double seconds = 0;
    std::uint64_t points = 0;
    bool right = false;
};

Timed count_crossings(const Layer& layer, std::uint64_t expected) {
    const auto start = Clock::now();
    const Crossings found = find_crossings(layer);
    return {seconds_since(start), layer.points.size(), found.count == expected};
}

Timed find_nesting(const Layer& layer, std::uint64_t depth) {
    const auto start = Clock::now();
    const Nesting found = nesting(layer);
    const double seconds = seconds_since(start);
    return {seconds, layer.points.size(), *std::ranges::max_element(found.depth) == depth};
}

Timed simplify_by(const Layer& layer, double tolerance) {
    const auto start = Clock::now();
    const Layer thinned = simplify(layer, tolerance);
    const double seconds = seconds_since(start);
    const LayerDifference difference = compare(layer, thinned);
    return {seconds, layer.points.size(),
            difference.distance_mm <= tolerance && thinned.rings == layer.rings && !has_crossings(thinned)};
}

Timed fill_nonzero(const Layer& layer) {
    const auto start = Clock::now();
    const Layer filled = fill(layer, FillRule::nonzero).layer;
    const double seconds = seconds_since(start);
    return {seconds, layer.points.size(),
            !has_crossings(filled) && !fill(filled, FillRule::nonzero).changed()};
}

/// Expected result of a step.
struct Expected {
    std::size_t rings;
    double area_mm2;
};

bool is(const Layer& layer, const Expected& expected) {
    const double area = measure(layer).area_mm2;
    return layer.rings == expected.rings &&
           std::abs(area - expected.area_mm2) <= 1e-6 * (1 + expected.area_mm2);
}

/// Fills a layer of which only the largest ring, `largest`, must be kept.
Timed fill_to_largest(const Layer& layer, const Expected& largest) {
    const auto start = Clock::now();
    const Layer filled = fill(layer, FillRule::nonzero).layer;
    return {seconds_since(start), layer.points.size(), is(filled, largest)};
}

/// Offsets outwards by a negligible distance.
Timed grow(const Layer& layer, const Expected& expected) {
    const auto start = Clock::now();
    const Layer grown = offset(layer, 1e-9);
    return {seconds_since(start), layer.points.size(), is(grown, expected)};
}

/// Outwards, or inwards if `by` is below 0: the result has no crossings and, filled, stays as it is.
Timed move_by(const Layer& layer, double by, OffsetCorner shape = OffsetCorner::mitre) {
    const auto start = Clock::now();
    const Layer moved = offset(layer, by, {.corners = {.shape = shape}});
    const double seconds = seconds_since(start);
    const double added = measure(moved).area_mm2 - measure(layer).area_mm2;
    return {seconds, layer.points.size(),
            (by > 0 ? added > 0 : added < 0) && !has_crossings(moved) &&
                !fill(moved, FillRule::nonzero).changed()};
}

/// Makes the vectors of all regions of the default strategy; checks the hatched area, mm^2.
Timed make_vectors(const Layer& layer, double area_mm2) {
    const ScanStrategy strategy;
    const auto start = Clock::now();
    const Plane vectors = scan(layer, {}, {}, strategy).vectors;
    const double seconds = seconds_since(start);
    double length = 0;
    for (const PointArray& hatches : vectors.hatches)
        for (std::size_t i = 0; i < hatches.size(); i += 2)
            length += std::hypot(hatches[i + 1].x - hatches[i].x, hatches[i + 1].y - hatches[i].y);
    const double hatched = length * strategy.hatch.distance;
    const double most = area_mm2 * (1 + strategy.hatch.overlap / strategy.hatch.cell); // stripes overlap
    return {seconds, layer.points.size(), hatched > 0.9 * area_mm2 && hatched <= most};
}

/// Offsets inwards until nothing is left.
Timed shrink_away(const Layer& layer, double by, OffsetCorner shape) {
    const auto start = Clock::now();
    const Layer left = offset(layer, -by, {.corners = {.shape = shape}});
    return {seconds_since(start), layer.points.size(), left.contours() == 0};
}

Timed compare_fins(int n) {
    const Layer layer = fins(n, 0);
    const Layer moved = fins(n, 1);
    const auto start = Clock::now();
    const double distance = compare(layer, moved).distance_mm;
    return {seconds_since(start), layer.points.size(), distance > 0.99e-5 && distance < 1.01e-5};
}

Timed join_hooks(int n) {
    const Layer layer = column_of_hooks(n);
    const auto start = Clock::now();
    const ClosedGaps closed = close_gaps(layer, 0.5);
    return {seconds_since(start), layer.points.size(),
            closed.layer.open_chains() == 1 && closed.refused == 0};
}

/// Layers by their approximate number of points.
struct Family {
    std::string what;
    std::function<Layer(int)> layer;
    Expected expected;
};

class Report {
  public:
    explicit Report(int rounds) : rounds_(rounds) {}

    template <class Measure>
    void add(const std::string& what, int smallest, const Measure& measure) {
        constexpr int sizes = 4;
        std::vector<double> seconds;
        std::vector<double> points;
        bool right = true;
        for (int k = 0; k < sizes; ++k) {
            std::vector<double> rounds;
            Timed last;
            for (int round = 0; round < rounds_; ++round) {
                last = measure_in_child<Timed>([&] { return measure(smallest << k); }).result;
                rounds.push_back(last.seconds);
                right = right && last.right;
            }
            seconds.push_back(median(rounds));
            points.push_back(static_cast<double>(last.points));
        }
        const double growth =
            std::log(seconds.back() / seconds.front()) / std::log(points.back() / points.front());
        std::vector<std::string> row{what, fmt::format("{:.0f}", points.back())};
        for (const double each : seconds)
            row.push_back(fmt::format("{:.4f}", each));
        row.push_back(fmt::format("{:.2f}", growth));
        row.push_back(fmt::format("{:.0f}", 1e9 * seconds.back() / points.back()));
        row.push_back(right ? "yes" : "WRONG");
        table_.add(std::move(row));
        right_ = right_ && right;
    }

    [[nodiscard]] std::string text() const { return table_.text(); }
    [[nodiscard]] bool right() const noexcept { return right_; }

  private:
    int rounds_;
    bool right_ = true;
    Table table_{{"layer", "points", "s", "twice", "4 times", "8 times", "growth", "ns/point", "checked"}};
};

int report(int argc, char** argv) {
    const Options options(argc, argv, "hostile_layers [--rounds 3]");
    const int rounds = options.rounds();
    std::cout << machine() << "; medians of " << rounds << " rounds, 1 thread\n\n";
    constexpr int n = 25000;
    const auto half = [](int lines) {
        return static_cast<std::uint64_t>(lines / 2);
    };
    Report report(rounds);
    report.add("crossings: fan", n, [&](int i) { return count_crossings(narrow_fan(i), half(i)); });
    report.add("crossings: fan of dashes", n,
               [&](int i) { return count_crossings(dashed_fan(i), half(i / 3)); });
    report.add("crossings: fan all around", n, [&](int i) { return count_crossings(round_fan(i), half(i)); });
    report.add("crossings: walls and a stray line", n, [&](int i) {
        return count_crossings(walls_and_stray(i), static_cast<std::uint64_t>(i) - 1 + half(i - 1));
    });
    report.add("crossings: star", n, [](int i) { return count_crossings(star(i), 0); });
    report.add("crossings: comb", n, [](int i) { return count_crossings(comb(i), 0); });
    report.add("nesting: rings in one place", n,
               [](int i) { return find_nesting(nest(i), static_cast<std::uint64_t>(i / 8)); });
    report.add("simplify: spiral, fine turns", n,
               [](int i) { return simplify_by(spiral_wall(i, i / 50.0), 0.001); });
    report.add("simplify: spiral, turns within reach", n,
               [](int i) { return simplify_by(spiral_wall(i, i / 50.0), 2500.0 / i); });
    report.add("simplify: zigzag", n, [](int i) { return simplify_by(zigzag(i), 0.01); });
    report.add("simplify: comb", n, [](int i) { return simplify_by(comb(i), 0.01); });
    report.add("simplify: star", n, [](int i) { return simplify_by(star(i), 0.001); });
    report.add("fill: plate over its copy", n, [](int i) { return fill_nonzero(plate_over_its_copy(i)); });
    report.add("fill: row of discs", n, [](int i) { return fill_nonzero(row_of_discs(i)); });
    report.add("fill: star", n, [](int i) { return fill_nonzero(star(i)); });
    report.add("fill: comb", n, [](int i) { return fill_nonzero(comb(i)); });
    report.add("offset: slivers", n,
               [](int i) { return shrink_away(slivers(i), 200 * turn / i, OffsetCorner::mitre); });
    constexpr int few = 4000;
    report.add("offset: slivers, crossings of all pairs", few,
               [](int i) { return shrink_away(slivers(i), 200 * turn / i, OffsetCorner::bevel); });
    // Nested rings, and the largest one as the result.
    const Expected octagon{1, 100 * 100 * 2 * std::numbers::sqrt2};
    const Expected rectangle{1, 200 * 100};
    const Expected kite{1, 2 * 50 * 50};
    const Expected small_octagon{1, 50 * 50 * 2 * std::numbers::sqrt2};
    for (const auto& [what, layer_of_points, expected] :
         {Family{"rings around one another", [](int i) { return concentric(i, false); }, octagon},
          Family{"rings on a line", [](int i) { return nested_on_a_line(i, 0, false); }, rectangle},
          Family{"rings on a line aslant", [](int i) { return nested_on_a_line(i, 0.3, false); }, rectangle},
          Family{"rings that touch in one point", nested_at_a_point, small_octagon},
          Family{"rings that share their left end", [](int i) { return nested_at_an_end(i, true); }, kite},
          Family{"rings that share their right end", [](int i) { return nested_at_an_end(i, false); },
                 kite}}) {
        const auto& layer = layer_of_points;
        const Expected& one = expected;
        report.add("fill: " + what, few, [&](int i) { return fill_to_largest(layer(i), one); });
        report.add("offset: " + what, few, [&](int i) { return grow(layer(i), one); });
        report.add("scan: " + what, few, [&](int i) { return make_vectors(layer(i), one.area_mm2); });
    }
    const Expected nothing{0, 0};
    const Expected body{1, 120 * 120};
    report.add("fill: flat rings from one point", few,
               [&](int i) { return fill_to_largest(flat_rings(i, false), nothing); });
    report.add("fill: flat rings in a body", few,
               [&](int i) { return fill_to_largest(flat_rings(i, true), body); });
    report.add("scan: flat rings in a body", few,
               [&](int i) { return make_vectors(flat_rings(i, true), body.area_mm2); });
    report.add("fill: bodies and holes around one another", few,
               [](int i) { return fill_nonzero(concentric(i, true)); });
    report.add("fill: bodies and holes on a line", few,
               [](int i) { return fill_nonzero(nested_on_a_line(i, 0, true)); });
    report.add("offset: bodies and holes around one another", few, [](int i) {
        return grow(concentric(i, true),
                    {static_cast<std::size_t>(i / 8), measure(concentric(i, true)).area_mm2});
    });
    report.add("offset: bodies and holes that share an end, crossings of all pairs", few,
               [](int i) { return move_by(nested_at_an_end(i, true, true), 0.1); });
    report.add("offset: the same inwards", few,
               [](int i) { return move_by(nested_at_an_end(i, true, true), -100.0 / i); });
    report.add("offset: petals, crossings of all pairs", few, [](int i) { return move_by(petals(i), 0.1); });
    report.add("offset: the same inwards, bevelled", few,
               [](int i) { return move_by(petals(i), -100.0 / i, OffsetCorner::bevel); });
    report.add("compare: fins side by side", n, compare_fins);
    report.add("gaps: chains in a column", n, join_hooks);
    std::cout << report.text();
    return report.right() ? 0 : 1;
}

} // namespace

} // namespace lamella::bench

int main(int argc, char** argv) {
    return lamella::bench::report(argc, argv);
}
