#include "scan/reached.hpp"

#include "lamella/polygon/offset.hpp"

#include "contour/box2.hpp"
#include "scan/occupied.hpp"
#include "scan/ring_side.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>

namespace lamella {

namespace {

/// Returns the distance beyond which no beam of these rules melts anything. Half of the width of the melt
/// pool is `beam_offset`; the pools of hatches are larger, by up to the factor of 4 that is granted here.
double farthest_reach(const ContourRule& contours, const ParameterSet& parameters) noexcept {
    const double farthest = std::max(4 * contours.beam_offset, 2 * parameters.spot_mm);
    return farthest > 0 ? farthest : std::numeric_limits<double>::infinity();
}

double rounded(double mm, const Rounding& rounding) noexcept {
    if (rounding.single_precision)
        mm = static_cast<double>(static_cast<float>(mm));
    return rounding.step_mm > 0 ? std::nearbyint(mm / rounding.step_mm) * rounding.step_mm : mm;
}

Point2 rounded(const Point2& p, const Rounding& rounding) noexcept {
    return {rounded(p.x, rounding), rounded(p.y, rounding)};
}

/// Appends the piece that fills the gap between the strips beside two sides that meet at p.
void add_corner(const Point2& p, const RingSide& before, const RingSide& after, double reach,
                Reached& reached) {
    const double turn = cross(before.way, after.way);
    const double cosine = dot_product(before.way, after.way);
    if (turn == 0 && cosine > 0)
        return;
    const double by = turn > 0 ? -reach : reach; // the gap lies on the outer side of the turn
    const auto beside = [&p, by](const Point2& way) {
        return Point2{p.x - by * way.y, p.y + by * way.x};
    };
    const Point2 first = beside(before.way);
    const Point2 last = beside(after.way);
    // The tip of a mitre is at the distance of reach / cos(half of the turn) from p.
    constexpr double longest = reached_mitre * (1 + OffsetCorners::mitre_tolerance);
    const double half = std::sqrt(std::max(0.0, (1 + cosine) / 2));
    const double further = half * longest >= 1
                               ? std::sqrt(std::max(0.0, 1 - half * half)) / half
                               : std::sqrt(std::max(0.0, 1 - half)) / std::sqrt(1 + half); // cut off
    const double along = further * reach;
    reached.corners.push_back({first,
                               {first.x + along * before.way.x, first.y + along * before.way.y},
                               {last.x - along * after.way.x, last.y - along * after.way.y},
                               last});
}

} // namespace

double contour_reach(const ContourRule& rule) noexcept {
    const double reach = rule.count > 1 ? std::max(rule.beam_offset, rule.distance / 2) : rule.beam_offset;
    return std::min(reach, farthest_reach(rule, rule.parameters));
}

double hatch_reach(const ContourRule& contours, const HatchRule& rule) noexcept {
    return std::min(rule.distance, farthest_reach(contours, rule.parameters));
}

void Reached::add(const Layer& polylines, std::span<const Point2> lines, double reach,
                  const Rounding& rounding) {
    std::vector<Point2> line;
    for (std::size_t i = 0; i < polylines.contours(); ++i) {
        line.clear();
        for (const Point2& p : polylines.contour(i))
            if (const Point2 at = rounded(p, rounding); line.empty() || line.back() != at)
                line.push_back(at);
        const bool ring = polylines.closed(i);
        while (ring && line.size() > 1 && line.front() == line.back())
            line.pop_back();
        for (std::size_t p = 1; p < line.size(); ++p)
            strokes.push_back({line[p - 1], line[p], reach});
        if (!ring || line.empty())
            continue;
        strokes.push_back({line.back(), line.front(), reach});
        RingSide before(line.back(), line.front());
        for (std::size_t p = 0; line.size() > 2 && p < line.size(); ++p) {
            const RingSide after(line[p], line[p + 1 == line.size() ? 0 : p + 1]);
            add_corner(line[p], before, after, reach, *this);
            before = after;
        }
    }
    for (std::size_t i = 0; i + 1 < lines.size(); i += 2)
        strokes.push_back({rounded(lines[i], rounding), rounded(lines[i + 1], rounding), reach});
}

Reached Reached::near(const Layer& area) const {
    Occupied occupied = Occupied::by_rings(area);
    Reached near;
    std::copy_if(strokes.begin(), strokes.end(), std::back_inserter(near.strokes), [&](const Stroke& stroke) {
        return occupied.any_within(Box2::of(stroke.from, stroke.to).grown(stroke.reach));
    });
    std::copy_if(corners.begin(), corners.end(), std::back_inserter(near.corners),
                 [&](const std::array<Point2, 4>& corner) { return occupied.any_within(box_of(corner)); });
    return near;
}

} // namespace lamella
