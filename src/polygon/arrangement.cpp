#include "polygon/arrangement.hpp"

#include "lamella/polygon/crossings.hpp"

#include "contour/distance.hpp"
#include "polygon/grid.hpp"
#include "polygon/orientation.hpp"
#include "polygon/segment_sweep.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// Adds up sides that lie upon one another.
void merge(Arrangement& arrangement) {
    std::vector<Side>& sides = arrangement.sides;
    std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
        return std::tie(a.line.lo, a.line.hi) < std::tie(b.line.lo, b.line.hi);
    });
    std::size_t kept = 0;
    for (const Side& side : sides)
        if (kept > 0 && sides[kept - 1].line.lo == side.line.lo && sides[kept - 1].line.hi == side.line.hi) {
            arrangement.walls = arrangement.walls || sides[kept - 1].step.left * side.step.left < 0;
            sides[kept - 1].step += side.step;
        } else {
            sides[kept++] = side;
        }
    sides.resize(kept);
    std::erase_if(sides, [](const Side& side) { return side.step == SideCount{}; });
}

/// The sides of the rings, not yet cut.
Arrangement sides_of(std::span<const WoundRing> rings, const ClippingGrid& grid) {
    Arrangement arrangement;
    for (const WoundRing& ring : rings) {
        if (ring.points.empty())
            continue;
        const SideCount step{ring.turn, ring.left};
        Point2 a = grid.place(ring.points.back());
        for (const Point2& p : ring.points) {
            const Point2 b = grid.place(p);
            if (a < b)
                arrangement.sides.push_back({{a, b}, step});
            else if (b < a)
                arrangement.sides.push_back({{b, a}, -1 * step});
            a = b;
        }
    }
    merge(arrangement);
    return arrangement;
}

/// Which ends a side is cut at that passes by.
enum class Reach : std::uint8_t {
    on_it,     ///< those that lie on it
    beside_it, ///< also those in whose squares of the grid it comes: then nothing crosses so close to an end
};

/// Whether the side comes into the unit square around p, up to rounding, between its own ends.
bool passes_by(const Segment& s, const Point2& p) noexcept {
    const double dx = s.hi.x - s.lo.x;
    const double dy = s.hi.y - s.lo.y;
    const double along = (p.x - s.lo.x) * dx + (p.y - s.lo.y) * dy;
    const double across = (p.y - s.lo.y) * dx - (p.x - s.lo.x) * dy;
    return 2 * std::abs(across) < std::abs(dx) + std::abs(dy) && along > 0 && along < dx * dx + dy * dy;
}

/// The ends of sides, sorted into cells.
class Ends {
  public:
    explicit Ends(std::span<const Side> sides) : ends_(ends_of(sides)), cells_(cells_for(ends_)) {
        const NumbersBelow numbers{static_cast<std::uint32_t>(ends_.size())};
        [[maybe_unused]] const bool sorted =
            cells_.sort(numbers, ends_.size(),
                        [this](std::uint32_t i, const auto& visit) { visit(cells_.cell(ends_[i])); });
        assert(sorted); // each end is in one cell
    }

    /// Calls visit(end) for the ends within the reach of the segment, but for its own.
    template <class Visit>
    void for_ends_on(const Segment& s, Reach reach, const Visit& visit) const {
        cells_.for_cells_along(s, [&](std::size_t cell) {
            for (const std::uint32_t i : cells_.in_cell(cell)) {
                const Point2& p = ends_[i];
                if (s.lo < p && p < s.hi && (reach == Reach::on_it ? side(s, p) == 0 : passes_by(s, p)))
                    visit(p);
            }
        });
    }

  private:
    static std::vector<Point2> ends_of(std::span<const Side> sides) {
        std::vector<Point2> ends;
        ends.reserve(2 * sides.size());
        for (const Side& side : sides)
            ends.insert(ends.end(), {side.line.lo, side.line.hi});
        std::sort(ends.begin(), ends.end());
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
        return ends;
    }

    /// Cells so large that a segment's margin covers the unit squares into which it comes.
    static Grid cells_for(std::span<const Point2> ends) {
        const Box2 box = box_of(ends);
        return {box, std::max(1 / Grid::margin, Grid::cell_size(box, static_cast<double>(ends.size()), 0))};
    }

    std::vector<Point2> ends_;
    Grid cells_;
};

struct Cut {
    std::size_t side;
    Point2 at;
};

/// Where sides cross, in the nearest place of the grid.
void add_crossings(const std::vector<Side>& sides, std::vector<Cut>& cuts) {
    Layer layer; // every side an open chain
    std::vector<Point2> points;
    for (const Side& side : sides) {
        points.insert(points.end(), {side.line.lo, side.line.hi});
        layer.offsets.push_back(points.size());
    }
    layer.points = PointArray(std::move(points));
    const auto add = [&](std::size_t i, const Point2& at) {
        if (at != sides[i].line.lo && at != sides[i].line.hi)
            cuts.push_back({i, at});
    };
    for (const Crossing& crossing : find_crossings(layer, std::numeric_limits<std::size_t>::max()).first) {
        const Point2 at{std::nearbyint(crossing.at.x) + 0.0, std::nearbyint(crossing.at.y) + 0.0};
        add(crossing.contour_a, at);
        add(crossing.contour_b, at);
    }
}

/// Cuts all sides where they cross others, in the nearest place of the grid, and where others end within
/// their reach. False when there was nothing to cut.
bool cut(Arrangement& arrangement, Reach reach) {
    std::vector<Side>& sides = arrangement.sides;
    std::vector<Cut> cuts;
    const Ends ends(sides);
    for (std::size_t i = 0; i < sides.size(); ++i)
        ends.for_ends_on(sides[i].line, reach, [&](const Point2& p) { cuts.push_back({i, p}); });
    // Sides that are drawn to an end cross elsewhere then, if at all.
    if (reach == Reach::on_it || cuts.empty())
        add_crossings(sides, cuts);
    if (cuts.empty())
        return false;
    const auto along = [&](const Cut& c) {
        const Segment& s = sides[c.side].line;
        return (c.at.x - s.lo.x) * (s.hi.x - s.lo.x) + (c.at.y - s.lo.y) * (s.hi.y - s.lo.y);
    };
    std::sort(cuts.begin(), cuts.end(), [&](const Cut& a, const Cut& b) {
        if (a.side != b.side)
            return a.side < b.side;
        return std::pair(along(a), a.at) < std::pair(along(b), b.at);
    });
    const auto add_piece = [&sides](const Point2& a, const Point2& b, const SideCount& step) {
        if (a < b)
            sides.push_back({{a, b}, step});
        else if (b < a)
            sides.push_back({{b, a}, -1 * step}); // bent back by rounding
    };
    for (std::size_t begin = 0, end = 0; begin < cuts.size(); begin = end) {
        const Side whole = sides[cuts[begin].side];
        Point2 from = whole.line.lo;
        for (end = begin; end < cuts.size() && cuts[end].side == cuts[begin].side; ++end) {
            add_piece(from, cuts[end].at, whole.step);
            from = cuts[end].at;
        }
        add_piece(from, whole.line.hi, whole.step);
        sides[cuts[begin].side].step = {};
    }
    merge(arrangement);
    return true;
}

/// Finds what is below each side, by a sweep from left to right. The sides meet in their ends only.
void wind(std::vector<Side>& sides, const SideCount& around) {
    std::vector<Segment> lines;
    lines.reserve(sides.size());
    for (const Side& side : sides)
        lines.push_back(side.line);
    SweepStatus status(lines);
    const std::vector<SweepEvent> events = sweep_events(lines, SweepOrder::ends_first);
    for (auto event = events.begin(); event != events.end();) {
        if (!event->begins) {
            status.erase(event->segment);
            ++event;
            continue;
        }
        // Sides that begin in one point are placed together, for each takes its number from the one below.
        const Point2 at = event->at;
        std::uint32_t side = event->segment;
        for (; event != events.end() && event->begins && event->at == at; ++event)
            status.insert(event->segment);
        const auto begins_here = [&](std::uint32_t i) {
            return i != SweepStatus::none && lines[i].lo == at;
        };
        while (begins_here(status.below(side)))
            side = status.below(side);
        const std::uint32_t next_below = status.below(side);
        SideCount below = next_below == SweepStatus::none ? around : sides[next_below].above();
        for (; begins_here(side); side = status.above(side)) {
            sides[side].below = below;
            below = sides[side].above();
        }
        assert(side == SweepStatus::none ? below == around : below == sides[side].below);
    }
    assert(status.empty());
}

/// A side with material on its left.
struct Directed {
    Point2 from;
    Point2 to;
};

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
std::vector<Ring> joined(std::vector<Directed> sides) {
    std::sort(sides.begin(), sides.end(), [](const Directed& a, const Directed& b) {
        return std::tie(a.from, a.to) < std::tie(b.from, b.to);
    });
    std::vector<bool> used(sides.size(), false);
    std::vector<Ring> rings;
    for (std::size_t start = 0; start < sides.size(); ++start) {
        if (used[start])
            continue;
        Ring& ring = rings.emplace_back();
        std::size_t at = start;
        while (true) {
            used[at] = true;
            ring.push_back(sides[at].from);
            const Point2& v = sides[at].to;
            std::size_t next = sides.size();
            const auto first = std::partition_point(sides.begin(), sides.end(),
                                                    [&](const Directed& s) { return s.from < v; });
            for (auto i = static_cast<std::size_t>(first - sides.begin());
                 i < sides.size() && sides[i].from == v; ++i)
                if ((!used[i] || i == start) &&
                    (next == sides.size() ||
                     clockwise_before(v, sides[at].from, sides[i].to, sides[next].to)))
                    next = i;
            assert(next != sides.size()); // as many sides begin in a point as end there
            if (next == start || next == sides.size())
                break;
            at = next;
        }
    }
    return rings;
}

/// Whether rings of which `winding` tells how often they wind around a place bound the material, up to areas
/// that rounding to the grid can make.
template <class Winding>
bool bounds(const Arrangement& arrangement, const Material& material, const Winding& winding) {
    double excess = 0; // the integral of by how much they do not
    double length = 0;
    const std::int64_t outside =
        (material(arrangement.around) ? 1 : 0) - winding(SideCount{arrangement.around, 0});
    const auto off = [&](const SideCount& count) {
        return static_cast<double>(std::abs(winding(count) + outside - (material(count.windings) ? 1 : 0)));
    };
    for (const Side& side : arrangement.sides) {
        const auto& [lo, hi] = side.line;
        length += distance(lo, hi);
        excess += (off(side.below) - off(side.above())) * (hi.x - lo.x) * (lo.y + hi.y) / 2;
    }
    return std::abs(excess) <= 2 * length;
}

bool crossing(const std::vector<Ring>& rings) {
    const std::vector<std::span<const Point2>> spans(rings.begin(), rings.end());
    return has_crossings(layer_of(spans));
}

/// Puts the corners of the given rings back where they were before they were rounded.
std::vector<Ring> with_corners(std::vector<Ring> rings, std::span<const WoundRing> given,
                               const ClippingGrid& grid) {
    std::vector<std::pair<Point2, Point2>> corners; // by their places
    for (const WoundRing& ring : given)
        for (const Point2& p : ring.points)
            corners.emplace_back(grid.place(p), p);
    std::sort(corners.begin(), corners.end()); // of several ones in a place the smallest counts
    for (Ring& ring : rings)
        for (Point2& p : ring) {
            const auto corner = std::partition_point(corners.begin(), corners.end(),
                                                     [&](const auto& c) { return c.first < p; });
            p = corner != corners.end() && corner->first == p ? corner->second : grid.point(p);
        }
    return rings;
}

} // namespace

Arrangement arranged(std::span<const WoundRing> rings, const Windings& around, const ClippingGrid& grid) {
    Arrangement arrangement = sides_of(rings, grid);
    // Rounding the places where sides cross bends them, so that they may cross others: each round has far
    // fewer. Sides that run side by side would cross again a unit further, round after round, if they were
    // not drawn to the ends that they pass by.
    constexpr int rounds = 30;
    Reach reach = Reach::on_it;
    for (int round = 0; round < rounds && !arrangement.sides.empty() && cut(arrangement, reach); ++round)
        reach = Reach::beside_it;
    arrangement.around = around;
    wind(arrangement.sides, {around, 0});
    return arrangement;
}

bool Arrangement::bounded_by_all(const Material& material) const {
    return bounds(*this, material, [](const SideCount& count) { return count.windings.sum(); });
}

bool Arrangement::bounded_by_rest(const Material& material) const {
    return bounds(*this, material, [](const SideCount& count) { return count.left; });
}

std::vector<Ring> boundary(const Arrangement& arrangement, const Material& material,
                           std::span<const WoundRing> rings, const ClippingGrid& grid) {
    std::vector<Directed> sides;
    for (const Side& side : arrangement.sides) {
        const bool above = material(side.above().windings);
        if (above != material(side.below.windings))
            sides.push_back(above ? Directed{side.line.lo, side.line.hi}
                                  : Directed{side.line.hi, side.line.lo});
    }
    std::vector<Ring> result = joined(std::move(sides));
    std::vector<Ring> at_corners = with_corners(result, rings, grid);
    if (!crossing(at_corners))
        return at_corners;
    for (Ring& ring : result)
        for (Point2& p : ring)
            p = grid.point(p);
    return result;
}

std::vector<Ring> filled(std::span<const std::span<const Point2>> rings, FillRule rule,
                         const ClippingGrid& grid) {
    std::vector<WoundRing> wound;
    wound.reserve(rings.size());
    for (const std::span<const Point2> ring : rings)
        wound.push_back({ring});
    return boundary(arranged(wound, {}, grid), Material(rule), wound, grid);
}

Layer layer_of(std::span<const std::span<const Point2>> rings) {
    Layer layer;
    std::vector<Point2> points;
    for (const std::span<const Point2> ring : rings) {
        points.insert(points.end(), ring.begin(), ring.end());
        layer.offsets.push_back(points.size());
    }
    layer.points = PointArray(std::move(points));
    layer.rings = rings.size();
    return layer;
}

} // namespace lamella
