#include "polygon/boundary.hpp"

#include "polygon/open_runs.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// A side with material on its left.
struct Directed {
    Point2 from;
    Point2 to;
    Point2 second; ///< place of it: the next one after `from`
    Point2 last;   ///< the one before `to`
    const Side* side;
};

Directed directed(const Arrangement& arrangement, const Side& side, bool rightwards) {
    const std::span<const Corner> corners = arrangement.corners_of(side);
    const auto& [lo, hi] = side.line;
    const Point2& next_to_lo = corners.empty() ? hi : corners.front().place;
    const Point2& next_to_hi = corners.empty() ? lo : corners.back().place;
    return rightwards ? Directed{lo, hi, next_to_lo, next_to_hi, &side}
                      : Directed{hi, lo, next_to_hi, next_to_lo, &side};
}

/// Whether, turning clockwise about v from the direction to u, a comes before b.
bool clockwise_before(const Point2& v, const Point2& u, const Point2& a, const Point2& b) noexcept {
    const auto half = [&](const Point2& p) {
        const int turn = orientation(v, u, p);
        if (turn != 0)
            return turn < 0 ? 0 : 2;
        return (u < v) == (p < v) ? 3 : 1;
    };
    const int half_a = half(a);
    const int half_b = half(b);
    return half_a != half_b ? half_a < half_b : orientation(v, a, b) < 0;
}

/// Joins sides to rings; where several meet, so that each keeps its own wedge of material.
std::vector<std::vector<Directed>> joined(std::vector<Directed> sides) {
    std::sort(sides.begin(), sides.end(), [](const Directed& a, const Directed& b) {
        return std::tie(a.from, a.second) < std::tie(b.from, b.second);
    });
    std::vector<bool> used(sides.size(), false);
    std::vector<std::vector<Directed>> rings;
    for (std::size_t start = 0; start < sides.size(); ++start) {
        if (used[start])
            continue;
        std::vector<Directed>& ring = rings.emplace_back();
        std::size_t at = start;
        while (true) {
            used[at] = true;
            ring.push_back(sides[at]);
            const Point2& v = sides[at].to;
            std::size_t next = sides.size();
            const auto first = std::partition_point(sides.begin(), sides.end(),
                                                    [&](const Directed& s) { return s.from < v; });
            for (auto i = static_cast<std::size_t>(first - sides.begin());
                 i < sides.size() && sides[i].from == v; ++i)
                if ((!used[i] || i == start) &&
                    (next == sides.size() ||
                     clockwise_before(v, sides[at].last, sides[i].second, sides[next].second)))
                    next = i;
            assert(next != sides.size()); // as many sides begin in a point as end there
            if (next == start || next == sides.size())
                break;
            at = next;
        }
    }
    return rings;
}

} // namespace

std::vector<Ring> boundary(const Arrangement& arrangement, const Material& material,
                           const ClippingGrid& grid) {
    std::vector<Directed> sides;
    for (const Side& side : arrangement.sides) {
        const bool above = material(side.above().windings);
        if (above != material(side.below.windings))
            sides.push_back(directed(arrangement, side, above));
    }
    std::vector<Corner> ends = arrangement.end_corners;
    std::sort(ends.begin(), ends.end(), [](const Corner& a, const Corner& b) {
        return std::tie(a.place, a.point) < std::tie(b.place, b.point);
    });
    // Of several corners in a place the smallest, and where there is none the place itself.
    const auto end_at = [&](const Point2& place) {
        const auto corner =
            std::partition_point(ends.begin(), ends.end(), [&](const Corner& c) { return c.place < place; });
        return corner != ends.end() && corner->place == place ? *corner : Corner{place, grid.point(place)};
    };
    std::vector<std::vector<Corner>> found;
    OpenRuns runs;
    for (const std::vector<Directed>& directed : joined(std::move(sides))) {
        std::vector<Corner>& ring = found.emplace_back();
        bool in_run = false;
        for (const Directed& side : directed) {
            ring.push_back(end_at(side.from));
            const std::span<const Corner> between = arrangement.corners_of(*side.side);
            if (side.from == side.side->line.lo)
                ring.insert(ring.end(), between.begin(), between.end());
            else
                ring.insert(ring.end(), between.rbegin(), between.rend());
            if (!side.side->alone && !in_run)
                runs.begin(ring.back().point);
            if (!side.side->alone)
                runs.go_on_to(end_at(side.to).point);
            in_run = !side.side->alone;
        }
    }
    const bool crossed = std::move(runs).crossed(); // by corners that were put back
    std::vector<Ring> result;
    for (const std::vector<Corner>& corners_of_ring : found) {
        Ring& ring = result.emplace_back();
        for (const Corner& corner : corners_of_ring)
            ring.push_back(crossed ? grid.point(corner.place) : corner.point);
    }
    return result;
}

std::vector<Ring> filled(std::span<const std::span<const Point2>> rings, FillRule rule,
                         const ClippingGrid& grid) {
    std::vector<WoundRing> wound;
    wound.reserve(rings.size());
    for (const std::span<const Point2> ring : rings)
        wound.push_back({ring});
    return boundary(arranged(wound, {}, grid), Material(rule), grid);
}

} // namespace lamella
