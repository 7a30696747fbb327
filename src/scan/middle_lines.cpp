#include "scan/middle_lines.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/rounding.hpp"

#include "contour/distance.hpp"
#include "polygon/orientation.hpp"
#include "scan/seeded.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

double dot(const Point2& a, const Point2& b) noexcept {
    return a.x * b.x + a.y * b.y;
}

Point2 minus(const Point2& a, const Point2& b) noexcept {
    return {a.x - b.x, a.y - b.y};
}

Point2 along(const Point2& from, const Point2& way, double by) noexcept {
    return {from.x + by * way.x, from.y + by * way.y};
}

/// Indices sorted by the cells of a square grid.
class Cells {
  public:
    explicit Cells(double side) : side_(side) {}

    void add(const Point2& p, std::uint32_t number) { all_.push_back({row(p.x), row(p.y), number}); }
    void sort() {
        std::sort(all_.begin(), all_.end());
        all_.erase(std::unique(all_.begin(), all_.end()), all_.end());
    }
    /// Calls visit(index) for all indices in the cell of a point and in the cells around it.
    template <class Visit>
    void around(const Point2& p, const Visit& visit) const {
        for (std::int64_t x = row(p.x) - 1; x <= row(p.x) + 1; ++x) {
            auto at = std::lower_bound(all_.begin(), all_.end(), Entry{x, row(p.y) - 1, 0});
            for (; at != all_.end() && std::get<0>(*at) == x && std::get<1>(*at) <= row(p.y) + 1; ++at)
                visit(std::get<2>(*at));
        }
    }

  private:
    using Entry = std::tuple<std::int64_t, std::int64_t, std::uint32_t>;

    [[nodiscard]] std::int64_t row(double x) const noexcept {
        return static_cast<std::int64_t>(std::floor(x / side_));
    }

    double side_;
    std::vector<Entry> all_;
};

/// A circle that touches the outline at two or more points.
struct Touching {
    Point2 middle;
    double radius = 0;
};

/// Points of the middle axis, in the order of the outline.
struct Axis {
    std::vector<Touching> points;
    bool closed = false;

    [[nodiscard]] double length() const noexcept {
        double sum = 0;
        for (std::size_t i = 1; i < points.size(); ++i)
            sum += distance(points[i - 1].middle, points[i].middle);
        return sum;
    }
};

class Outlines {
  public:
    Outlines(const Layer& material, double width, double thinnest, const LayerBudget& budget)
        : material_(material), budget_(budget), width_(width), thinnest_(thinnest),
          unit_(unit_of(material, width)), cells_(unit_) {
        // Both sides of each area have touching circles, from which the lines are built.
        constexpr std::uint64_t bytes_each = 3 * sizeof(Touching) + 2 * sizeof(Point2);
        budget.need(4 * static_cast<std::uint64_t>(measure(material).perimeter_mm / unit_) +
                        material.points.size(),
                    bytes_each, "places along thin walls");
        for (std::size_t ring = 0; ring < material.rings; ++ring) {
            const std::span<const Point2> points = material.contour(ring);
            for (std::size_t i = 0; i < points.size(); ++i) {
                const Edge edge{points[i], points[i + 1 < points.size() ? i + 1 : 0]};
                const std::size_t pieces = 1 + static_cast<std::size_t>(distance(edge.a, edge.b) / unit_ * 2);
                for (std::size_t k = 0; k <= pieces; ++k)
                    cells_.add(along(edge.a, minus(edge.b, edge.a),
                                     static_cast<double>(k) / static_cast<double>(pieces)),
                               static_cast<std::uint32_t>(edges_.size()));
                edges_.push_back(edge);
            }
        }
        cells_.sort();
    }

    [[nodiscard]] double step() const noexcept { return unit_ / 4; }

    /// Returns whether a segment meets the outline.
    [[nodiscard]] bool crossed_by(const Point2& a, const Point2& b) const {
        const Point2 way = minus(b, a);
        const double steps = 1 + std::floor(2 * std::sqrt(dot(way, way)) / unit_);
        bool crosses = false;
        for (double k = 0; k <= steps && !crosses; ++k)
            cells_.around(along(a, way, k / steps), [&](std::uint32_t number) {
                const Edge& edge = edges_[number];
                crosses = crosses || meet(segment_between(a, b), segment_between(edge.a, edge.b));
            });
        return crosses;
    }

    /// Returns the middle axes of the samples of each ring, in connected sections.
    [[nodiscard]] std::vector<Axis> axes() const {
        std::vector<Axis> all;
        for (std::size_t ring = 0; ring < material_.rings; ++ring)
            add_axes(touching_of(ring), all);
        return all;
    }

  private:
    struct Edge {
        Point2 a;
        Point2 b;
    };

    /// Returns the width, or more if that would make too many pieces.
    [[nodiscard]] static double unit_of(const Layer& material, double width) noexcept {
        constexpr double most_pieces = 1 << 19;
        return std::max({width, measure(material).perimeter_mm / most_pieces,
                         largest_coordinate(material.points.span()) * 0x1p-40});
    }

    [[nodiscard]] std::vector<std::optional<Touching>> touching_of(std::size_t ring) const {
        std::vector<std::optional<Touching>> found;
        const std::span<const Point2> points = material_.contour(ring);
        for (std::size_t i = 0; i < points.size(); ++i) {
            const Point2& a = points[i];
            const Point2 edge = minus(points[i + 1 < points.size() ? i + 1 : 0], a);
            const double length = std::sqrt(dot(edge, edge));
            if (!(length > 0))
                continue;
            const double pieces = 1 + std::floor(length / step());
            for (double k = 0.5; k < pieces; ++k) {
                budget_.check();
                found.push_back(touching(along(a, edge, k / pieces), {-edge.y / length, edge.x / length}));
            }
        }
        return found;
    }

    /// Returns the largest circle that touches the outline at p from inside. While a circle is too large, it
    /// is replaced by one that also touches the point of the outline nearest to its centre. Returns nullopt
    /// if the two points are not opposite each other.
    [[nodiscard]] std::optional<Touching> touching(const Point2& p, const Point2& inwards) const {
        constexpr int most = 50;
        constexpr double rounding = 1e-7;
        constexpr double opposite = -0.5; // cosine of 120 degrees; it is 0 in corners of 90 degrees
        double radius = 0.55 * width_;
        Point2 other = p;
        for (int step = 0; step < most; ++step) {
            const Point2 middle = along(p, inwards, radius);
            double nearest = radius * (1 - rounding);
            bool is_there = false;
            cells_.around(middle, [&](std::uint32_t number) {
                const Point2 q = nearest_on(edges_[number].a, edges_[number].b, middle);
                const double away = distance(q, middle);
                if (away >= nearest || !(dot(minus(q, p), inwards) > rounding * width_))
                    return;
                nearest = away;
                other = q;
                is_there = true;
            });
            if (is_there) {
                const Point2 to = minus(other, p);
                radius = dot(to, to) / (2 * dot(to, inwards));
                continue;
            }
            const Point2 to = minus(other, middle);
            const bool counts = 2 * radius < width_ * (1 + 1e-6) && 2 * radius >= thinnest_ &&
                                dot(minus(p, middle), to) < opposite * radius * std::sqrt(dot(to, to));
            return counts ? std::optional(Touching{middle, radius}) : std::nullopt;
        }
        return std::nullopt;
    }

    /// Returns whether the line between two centres leaves the area.
    [[nodiscard]] bool leaves_area(const Touching& one, const Touching& other) const {
        const Point2 way = minus(other.middle, one.middle);
        const double within = one.radius + other.radius;
        return dot(way, way) > within * within && crossed_by(one.middle, other.middle);
    }

    /// Divides the axis at samples without a circle, at samples far from the previous circle, where it would
    /// leave the area, and where it turns back. It turns back at a round end, around which it is traversed
    /// twice.
    void add_axes(const std::vector<std::optional<Touching>>& found, std::vector<Axis>& all) const {
        const std::size_t count = found.size();
        std::vector<bool> cut(count, false);
        Point2 way; // last step of non-zero length
        for (std::size_t k = 0; k < 2 * count; ++k) {
            const std::size_t i = k % count;
            const std::optional<Touching>& before = found[(i == 0 ? count : i) - 1];
            const Point2 to = before && found[i] ? minus(found[i]->middle, before->middle) : Point2{};
            const double squared = dot(to, to);
            if (!before || !found[i] || squared > 4 * step() * step() || leaves_area(*before, *found[i])) {
                cut[i] = true;
                way = {};
            } else if (squared > step() * step() / 16) {
                cut[i] = cut[i] || dot(to, way) < 0;
                way = to;
            }
        }
        const auto first = static_cast<std::size_t>(std::find(cut.begin(), cut.end(), true) - cut.begin());
        Axis axis;
        for (std::size_t k = 0; k < count; ++k) {
            const std::size_t i = (first + k) % count;
            if (cut[i] && !axis.points.empty())
                all.push_back(std::exchange(axis, {}));
            if (found[i])
                axis.points.push_back(*found[i]);
        }
        if (axis.points.empty())
            return;
        axis.closed = first == count;
        if (axis.closed)
            axis.points.push_back(axis.points.front());
        all.push_back(std::move(axis));
    }

    const Layer& material_;
    const LayerBudget& budget_;
    double width_;
    double thinnest_;
    double unit_;
    std::vector<Edge> edges_;
    Cells cells_;
};

/// Removes copies of axes. Both sides of an area have the same axis, so points near a longer axis are
/// removed.
std::vector<Axis> without_copies(std::vector<Axis> axes, double near) {
    // Lengths are compared as integer multiples of a millionth, because those of both sides of an area differ
    // by rounding.
    std::vector<std::pair<double, std::size_t>> order;
    for (const Axis& axis : axes)
        order.emplace_back(-std::floor(axis.length() / near * 0x1p20), order.size());
    std::sort(order.begin(), order.end());
    std::vector<Axis> kept;
    std::vector<Point2> points; // of the kept axes
    std::size_t total = 1;
    for (const Axis& axis : axes)
        total += axis.points.size();
    std::vector<std::vector<std::uint32_t>> buckets(total); // indices of points, by their cells
    const auto row = [&](double x) {
        return static_cast<std::int64_t>(std::floor(x / near));
    };
    const auto bucket = [&](std::int64_t x, std::int64_t y) -> std::vector<std::uint32_t>& {
        return buckets[seeded(static_cast<std::uint64_t>(x), {static_cast<std::uint64_t>(y)}) %
                       buckets.size()];
    };
    const auto is_taken = [&](const Point2& p) {
        for (std::int64_t x = row(p.x) - 1; x <= row(p.x) + 1; ++x)
            for (std::int64_t y = row(p.y) - 1; y <= row(p.y) + 1; ++y)
                for (const std::uint32_t number : bucket(x, y))
                    if (distance(points[number], p) <= near)
                        return true;
        return false;
    };
    for (const auto& [length, number] : order) {
        const Axis& axis = axes[number];
        std::vector<Axis> runs(1);
        bool whole = true;
        for (const Touching& point : axis.points) {
            if (!is_taken(point.middle)) {
                runs.back().points.push_back(point);
                continue;
            }
            whole = false;
            if (!runs.back().points.empty())
                runs.emplace_back();
        }
        if (whole)
            runs.front().closed = axis.closed;
        for (Axis& run : runs) {
            for (const Touching& point : run.points) {
                bucket(row(point.middle.x), row(point.middle.y))
                    .push_back(static_cast<std::uint32_t>(points.size()));
                points.push_back(point.middle);
            }
            if (run.points.size() > 1)
                kept.push_back(std::move(run));
        }
    }
    return kept;
}

/// Removes points that are within the tolerance of the segment between the remaining points (Douglas,
/// Peucker), if the segment stays within the area.
std::vector<Point2> straightened(const std::vector<Point2>& points, double tolerance,
                                 const Outlines& outlines) {
    std::vector<bool> kept(points.size(), false);
    kept.front() = kept.back() = true;
    std::vector<std::pair<std::size_t, std::size_t>> open{{0, points.size() - 1}};
    while (!open.empty()) {
        const auto [first, last] = open.back();
        open.pop_back();
        double most = tolerance;
        std::size_t farthest = first;
        for (std::size_t i = first + 1; i < last; ++i)
            if (const double away = distance(nearest_on(points[first], points[last], points[i]), points[i]);
                away > most) {
                most = away;
                farthest = i;
            }
        if (farthest == first) {
            if (last == first + 1 || !outlines.crossed_by(points[first], points[last]))
                continue;
            farthest = (first + last) / 2;
        }
        kept[farthest] = true;
        open.emplace_back(first, farthest);
        open.emplace_back(farthest, last);
    }
    std::vector<Point2> result;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (kept[i])
            result.push_back(points[i]);
    return result;
}

/// Extends an end of a line by three quarters of the radius of its touching circle, so that it stays within
/// the circle.
void lengthen(std::vector<Point2>& points, double radius, bool at_begin) {
    Point2& end = at_begin ? points.front() : points.back();
    const Point2& before = at_begin ? points[1] : points[points.size() - 2];
    const double apart = distance(before, end);
    if (apart > 0)
        end = along(end, minus(end, before), 0.75 * radius / apart);
}

double length_of(const std::vector<Point2>& points) noexcept {
    double sum = 0;
    for (std::size_t i = 1; i < points.size(); ++i)
        sum += distance(points[i - 1], points[i]);
    return sum;
}

} // namespace

std::vector<std::vector<Point2>> middle_lines(const Layer& material, double width, double thinnest,
                                              const LayerBudget& budget) {
    if (material.rings == 0 || !(width > 0))
        return {};
    constexpr double straight = 0.01;
    const Outlines outlines(material, width, thinnest, budget);
    std::vector<std::vector<Point2>> lines;
    for (const Axis& axis : without_copies(outlines.axes(), 1.5 * outlines.step())) {
        std::vector<Point2> points;
        for (const Touching& point : axis.points)
            points.push_back(point.middle);
        points = straightened(points, straight * width, outlines);
        if (!axis.closed) {
            lengthen(points, axis.points.front().radius, true);
            lengthen(points, axis.points.back().radius, false);
        }
        if (length_of(points) < width / 2)
            continue;
        for (Point2& p : points)
            p = {p.x + 0.0, p.y + 0.0};
        if (!axis.closed &&
            std::tie(points.back().x, points.back().y) < std::tie(points.front().x, points.front().y))
            std::reverse(points.begin(), points.end());
        lines.push_back(std::move(points));
    }
    std::sort(lines.begin(), lines.end(), [](const auto& a, const auto& b) {
        return std::tie(a.front().x, a.front().y, a.back().x, a.back().y) <
               std::tie(b.front().x, b.front().y, b.back().x, b.back().y);
    });
    return lines;
}

} // namespace lamella
