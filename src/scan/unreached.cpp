#include "scan/unreached.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/core/unit_circle.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/nesting.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/box2.hpp"
#include "scan/hatch.hpp"
#include "scan/hatch_lines.hpp"
#include "scan/occupied.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <limits>
#include <tuple>
#include <vector>

namespace lamella {

namespace {

/// A corner of a ring.
struct Corner {
    double cross;   ///< cross product of the sides before and after it
    double dot;     ///< dot product of these sides
    double lengths; ///< product of their lengths
    double after;   ///< length of the side after it

    /// Returns whether the corner is sharper than the limit of mitres, 60 degrees.
    [[nodiscard]] bool sharp() const noexcept { return cross > 0 && dot < -0.5 * lengths; }
    /// Returns the tangent of half of the angle by which the ring turns.
    [[nodiscard]] double tangent() const noexcept { return cross / (lengths + dot); }
    /// Returns the area that the corner adds to the strips along its sides when the ring is offset outwards
    /// by 1. The mitre of a sharp corner is truncated, so it adds the area of two corners of half the turn.
    [[nodiscard]] double grown() const noexcept {
        if (!sharp())
            return lengths + dot > 0 ? tangent() : 0;
        const double cosine = std::sqrt(std::max(0.0, (1 + dot / lengths) / 2));
        return 2 * std::sqrt(1 - cosine * cosine) / (1 + cosine);
    }
};

template <class Visit>
void for_corners(std::span<const Point2> ring, const Visit& visit) {
    if (ring.empty())
        return;
    const Point2& last = ring.back();
    Point2 u{ring.front().x - last.x, ring.front().y - last.y};
    double before = std::sqrt(u.x * u.x + u.y * u.y);
    for (std::size_t k = 0; k < ring.size(); ++k) {
        const Point2& next = ring[k + 1 == ring.size() ? 0 : k + 1];
        const Point2 v{next.x - ring[k].x, next.y - ring[k].y};
        const double after = std::sqrt(v.x * v.x + v.y * v.y);
        visit(Corner{u.x * v.y - u.y * v.x, u.x * v.x + u.y * v.y, before * after, after});
        u = v;
        before = after;
    }
}

/// Returns the area inside of the rings after they are grown. Requires that grown rings do not overlap. Near
/// the end of a neck they may, by less than the square of the distance.
double grown_area(const Layer& layer, double by) {
    static_assert(OffsetCorners{}.mitre_limit == 2);
    double area = 0;
    double length = 0;
    double corners = 0;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        area += ring_area(layer.contour(i));
        for_corners(layer.contour(i), [&](const Corner& corner) {
            length += corner.after;
            corners += corner.grown();
        });
    }
    return area + by * length + by * by * corners;
}

/// Returns the unreached area in the tips of sharp corners of 30 degrees and more, which a beam of finite
/// width always rounds off.
double tips_area(const Layer& layer, double by) {
    constexpr double sharpest = -0.8660254; // the cosine of 180 - 30 degrees
    double corners = 0;
    for (std::size_t i = 0; i < layer.rings; ++i)
        for_corners(layer.contour(i), [&](const Corner& corner) {
            if (corner.sharp() && corner.dot >= sharpest * corner.lengths)
                corners += corner.tangent() - corner.grown();
        });
    return by * by * corners;
}

/// Returns whether each side of a layer's rings corresponds to a side of its inset, and vice versa.
bool side_by_side(const Layer& layer, const Layer& inset) noexcept {
    if (layer.rings != inset.rings || layer.offsets != inset.offsets)
        return false;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        const std::span<const Point2> one = layer.contour(i);
        const std::span<const Point2> other = inset.contour(i);
        Point2 p = one.back();
        Point2 q = other.back();
        for (std::size_t k = 0; k < one.size(); ++k) {
            const Point2 u{one[k].x - p.x, one[k].y - p.y};
            const Point2 v{other[k].x - q.x, other[k].y - q.y};
            constexpr double parallel = 1e-6;
            const double dot = u.x * v.x + u.y * v.y;
            if (!(std::abs(u.x * v.y - u.y * v.x) <= parallel * dot))
                return false;
            p = one[k];
            q = other[k];
        }
    }
    return true;
}

/// The interval of a line that a stroke reaches. It is a single interval because the outline of a stroke is
/// convex.
class Within {
  public:
    void add(double u) noexcept {
        from_ = std::min(from_, u);
        to_ = std::max(to_, u);
    }
    /// Adds the intersection with a circle.
    void add_circle(double u, double off, double radius) noexcept {
        if (const double squared = radius * radius - off * off; squared >= 0) {
            add(u - std::sqrt(squared));
            add(u + std::sqrt(squared));
        }
    }
    /// Adds the intersection with the side from (u0, v0) to (u1, v1), on a line at v.
    void add_side(double u0, double v0, double u1, double v1, double v) noexcept {
        if ((v0 <= v) != (v1 <= v))
            add(u0 + (v - v0) / (v1 - v0) * (u1 - u0));
    }
    [[nodiscard]] double from() const noexcept { return from_; }
    [[nodiscard]] double to() const noexcept { return to_; }

  private:
    double from_ = std::numeric_limits<double>::infinity();
    double to_ = -from_;
};

struct Reached {
    std::size_t line;
    double from;
    double to;

    friend bool operator<(const Reached& a, const Reached& b) noexcept {
        return std::tie(a.line, a.from, a.to) < std::tie(b.line, b.from, b.to);
    }
};

double least_reach(std::span<const Stroke> strokes) noexcept {
    double least = std::numeric_limits<double>::infinity();
    for (const Stroke& stroke : strokes)
        if (stroke.reach > 0)
            least = std::min(least, stroke.reach);
    return least;
}

constexpr double next_to_nothing = 1.0 / 2; // negligible area, in squares of a distance

} // namespace

Layer narrow_points(const Layer& material, const Layer& inset, double by, const LayerLimits& limits) {
    constexpr double more = 1 + 1e-3; // so that no slivers remain
    if (!(by > 0) || material.rings == 0)
        return {};
    if (inset.rings == 0)
        return material;
    if (side_by_side(material, inset))
        return {};
    const double lost = measure(material).area_mm2 - grown_area(inset, by);
    if (lost <= next_to_nothing * by * by || lost - tips_area(material, by) <= next_to_nothing * by * by)
        return {};
    const Layer positions =
        combine(material, offset(inset, by * more, {.limits = limits}), BooleanOperation::subtract, limits);
    return measure(positions).area_mm2 > next_to_nothing * by * by ? positions : Layer{};
}

Layer narrow_points(const Layer& material, double depth, const ContourRule& contours,
                    const HatchRule& hatch) {
    std::vector<double> steps;
    for (std::uint32_t i = 1; i <= contours.count; ++i)
        if (const double to = contour_depth(contours, i) - depth; to > 0)
            steps.push_back(-to);
    const double filled = hatch_depth(contours, hatch) - depth;
    steps.push_back(-std::max(0.0, filled));
    steps.push_back(-std::max(0.0, filled) - surely_hatched(hatch) / 2);
    const std::vector<Layer> insets = offsets(material, steps);
    Layer all;
    const Layer* outer = &material;
    double last = 0;
    for (std::size_t i = 0; i < steps.size(); ++i) {
        all = combine(all, narrow_points(*outer, insets[i], last - steps[i]), BooleanOperation::unite);
        outer = &insets[i];
        last = steps[i];
    }
    return all;
}

double contour_reach(const ContourRule& rule) noexcept {
    return rule.count > 1 ? std::max(rule.beam_offset, rule.distance / 2) : rule.beam_offset;
}

void add_strokes(const Layer& polylines, std::span<const Point2> hatches, double reach,
                 std::vector<Stroke>& strokes) {
    for (std::size_t i = 0; i < polylines.contours(); ++i) {
        const std::span<const Point2> line = polylines.contour(i);
        for (std::size_t p = 1; p < line.size(); ++p)
            strokes.push_back({line[p - 1], line[p], reach});
        if (polylines.closed(i) && !line.empty())
            strokes.push_back({line.back(), line.front(), reach});
    }
    for (std::size_t i = 0; i + 1 < hatches.size(); i += 2)
        strokes.push_back({hatches[i], hatches[i + 1], reach});
}

double unreached_area(const Layer& positions, std::span<const Stroke> strokes, const LayerBudget& budget) {
    if (positions.rings == 0)
        return 0;
    const double area = measure(positions).area_mm2;
    const Box2 box = box_of(positions.points.span());
    const double least = least_reach(strokes);
    if (!std::isfinite(least))
        return std::max(0.0, area);
    // This angle is oblique to the usual directions of walls and hatches.
    constexpr double angle = 27.18;
    constexpr double most_lines = 1 << 15;
    const double distance =
        std::max({least / 2, (box.width() + box.height()) / most_lines, box.largest_coordinate() * 0x1p-40});
    const HatchLines lines(positions, cos_sin_degrees(angle), distance, 0, budget);
    const LineFrame& frame = lines.frame();
    Occupied occupied(positions); // most strokes are far from all rings
    for (std::size_t i = 0; i < positions.rings; ++i)
        occupied.add(box_of(positions.contour(i)));
    std::vector<Reached> reached;
    for (const auto& [a, b, reach] : strokes) {
        budget.check();
        const Box2 around = Box2::of(a, b).grown(reach);
        if (!box.meets(around) || !occupied.any_within(around))
            continue;
        const double u0 = frame.along(a);
        const double v0 = frame.across(a);
        const double u1 = frame.along(b);
        const double v1 = frame.across(b);
        const double length = std::sqrt((u1 - u0) * (u1 - u0) + (v1 - v0) * (v1 - v0));
        const double du = length > 0 ? -(v1 - v0) / length * reach : 0; // to the left
        const double dv = length > 0 ? (u1 - u0) / length * reach : 0;
        const double first = (std::min(v0, v1) - reach) / distance - static_cast<double>(lines.first());
        const double last = (std::max(v0, v1) + reach) / distance - static_cast<double>(lines.first());
        const auto end = static_cast<std::size_t>(
            std::clamp(std::floor(last) + 1, 0.0, static_cast<double>(lines.size())));
        for (auto i = static_cast<std::size_t>(std::max(0.0, std::ceil(first))); i < end; ++i) {
            const std::span<const double> ends = lines.ends(i);
            if (ends.empty())
                continue;
            const double v = lines.v(i);
            Within within;
            within.add_circle(u0, v - v0, reach);
            within.add_circle(u1, v - v1, reach);
            within.add_side(u0 + du, v0 + dv, u1 + du, v1 + dv, v);
            within.add_side(u0 - du, v0 - dv, u1 - du, v1 - dv, v);
            const auto next = std::upper_bound(ends.begin(), ends.end(), within.from());
            const bool inside = (next - ends.begin()) % 2 == 1;
            if (inside || (next != ends.end() && *next < within.to())) {
                if (reached.size() == reached.capacity())
                    budget.need(2 * reached.size(), sizeof(Reached), "places that vectors reach");
                reached.push_back({i, within.from(), within.to()});
            }
        }
    }
    std::sort(reached.begin(), reached.end());
    double all = 0;
    double left = 0;
    auto next = reached.begin();
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const auto begin = next;
        while (next != reached.end() && next->line == i)
            ++next;
        const std::span<const double> ends = lines.ends(i);
        for (std::size_t k = 0; k < ends.size(); k += 2) {
            all += ends[k + 1] - ends[k];
            double at = ends[k];
            for (auto one = begin; one != next && one->from < ends[k + 1]; ++one) {
                left += std::max(0.0, one->from - at);
                at = std::max(at, one->to);
            }
            left += std::max(0.0, ends[k + 1] - at);
        }
    }
    return all > 0 ? std::max(0.0, area) * (left / all) : 0;
}

Layer bare_points(const Layer& positions, std::span<const Stroke> strokes, const LayerBudget& budget) {
    const double reach = least_reach(strokes);
    const double accepted =
        std::isfinite(reach) ? reach * reach / 32 : 0; // small, since many such areas are not negligible
    if (!(unreached_area(positions, strokes, budget) > accepted))
        return {};
    Occupied occupied(positions);
    for (std::size_t i = 0; i < positions.rings; ++i)
        occupied.add(box_of(positions.contour(i)));
    budget.need(strokes.size(), sizeof(Stroke), "scan vectors");
    std::vector<Stroke> near;
    std::copy_if(strokes.begin(), strokes.end(), std::back_inserter(near), [&](const Stroke& stroke) {
        return occupied.any_within(Box2::of(stroke.from, stroke.to).grown(stroke.reach));
    });
    LayerBuilder bare;
    for (const Polygon& body : polygons(nesting(positions))) {
        std::vector<std::uint32_t> rings{body.outer};
        rings.insert(rings.end(), body.holes.begin(), body.holes.end());
        LayerBuilder one;
        for (const std::uint32_t ring : rings)
            one.add_contour(positions.contour(ring), true);
        if (unreached_area(one.finish(positions.index, positions.z, positions.bottom, positions.top), near,
                           budget) > accepted)
            for (const std::uint32_t ring : rings)
                bare.add_contour(positions.contour(ring), true);
    }
    return normal_form(bare.finish(positions.index, positions.z, positions.bottom, positions.top));
}

} // namespace lamella
