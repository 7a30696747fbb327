#include "polygon/arrangement.hpp"

#include "lamella/polygon/crossings.hpp"

#include "contour/distance.hpp"
#include "polygon/close_sides.hpp"
#include "polygon/grid.hpp"
#include "polygon/open_runs.hpp"
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

/// How close sides can be that others are drawn to when these are cut: each end and each piece moves by less
/// than the diagonal of a unit square.
constexpr double reach_of_cuts = 4;

/// The sides of rings, not yet cut.
class Uncut {
  public:
    Uncut(std::span<const WoundRing> rings, const ClippingGrid& grid) {
        std::vector<Point2> places;
        for (const WoundRing& ring : rings) {
            for (const Point2& p : ring.points)
                places.push_back(grid.place(p));
            layer_.offsets.push_back(places.size());
        }
        layer_.rings = rings.size();
        layer_.points = PointArray(std::move(places));
        close_ = close_sides(layer_, reach_of_cuts);
        OpenRuns runs;
        for (std::size_t i = 0; i < rings.size(); ++i)
            add(rings[i], i, runs);
        arrangement.crossed = std::move(runs).crossed();
        merge(arrangement);
    }

    Arrangement arrangement; ///< of sides that may come close to others
    std::vector<Side> alone; ///< the rest

  private:
    void add(const WoundRing& ring, std::size_t number, OpenRuns& runs) {
        const std::span<const Point2> places = layer_.contour(number);
        const std::size_t n = places.size();
        const SideCount step{ring.turn, ring.left};
        const auto after = [n](std::size_t i) {
            return i + 1 < n ? i + 1 : 0;
        };
        const auto close = [&](std::size_t i) -> bool {
            return close_[layer_.offsets[number] + i];
        };
        const auto rightwards = [&](std::size_t i) {
            return places[i] < places[after(i)];
        };
        for (std::size_t i = 0; i < n;) {
            arrangement.end_corners.push_back({places[i], ring.points[i]});
            if (close(i)) {
                if (i == 0 || !close(i - 1))
                    runs.begin(ring.points[i]);
                runs.go_on_to(ring.points[after(i)]);
                if (places[i] != places[after(i)])
                    arrangement.sides.push_back({.line = segment_between(places[i], places[after(i)]),
                                                 .step = (rightwards(i) ? 1 : -1) * step});
                ++i;
                continue;
            }
            std::size_t last = i; // of the sides that go the same way
            while (last + 1 < n && !close(last + 1) && rightwards(last + 1) == rightwards(i))
                ++last;
            const auto first = static_cast<std::uint32_t>(arrangement.corners.size());
            for (std::size_t k = i + 1; k <= last; ++k) {
                const std::size_t corner = rightwards(i) ? k : last + 1 + i - k;
                arrangement.corners.push_back({places[corner], ring.points[corner]});
            }
            alone.push_back({.line = segment_between(places[i], places[after(last)]),
                             .step = (rightwards(i) ? 1 : -1) * step,
                             .alone = true,
                             .first = first,
                             .corners = static_cast<std::uint32_t>(last - i)});
            i = last + 1;
        }
    }

    Layer layer_; ///< of places
    std::vector<bool> close_;
};

// Snap rounding (Hobby 1999; Guibas and Marimont 1998). The plane is tiled by unit squares around the places
// of the grid, each with its lower and its left border. Squares in which sides end or cross are hot, and each
// side is drawn to the places of all hot squares that it comes into. Sides may come to lie upon one another
// then, but never cross: outside of hot squares they did not, and each square shrinks to its place. That is
// so for the sides as they are given, all at once, and decided exactly: sides that are bent first and looked
// at again may drift from place to place.

__extension__ using Wide = __int128;

/// A difference of places, at most 2^38.
std::int64_t whole(double number) noexcept {
    return static_cast<std::int64_t>(number);
}

struct Vector {
    std::int64_t x;
    std::int64_t y;
};

Vector from_to(const Point2& a, const Point2& b) noexcept {
    return {whole(b.x - a.x), whole(b.y - a.y)};
}

Wide cross(const Vector& a, const Vector& b) noexcept {
    return Wide{a.x} * b.y - Wide{a.y} * b.x;
}

/// The place in whose square two sides cross properly.
Point2 crossing_place(const Segment& a, const Segment& b) noexcept {
    const Vector u = from_to(a.lo, a.hi);
    const Vector v = from_to(b.lo, b.hi);
    Wide of = cross(u, v);
    Wide share = cross(from_to(a.lo, b.lo), v); // of u, up to the crossing
    if (of < 0) {
        of = -of;
        share = -share;
    }
    assert(of > 0 && share > 0 && share < of);
    const auto nearest = [&](std::int64_t way) { // halves upwards
        const Wide twice = 2 * share * way + of;
        const Wide floor = twice / (2 * of) - (twice % (2 * of) < 0 ? 1 : 0);
        return static_cast<double>(static_cast<std::int64_t>(floor));
    };
    return {a.lo.x + nearest(u.x), a.lo.y + nearest(u.y)};
}

/// Whether a side comes into the square of a place that is not one of its ends.
bool comes_into(const Segment& s, const Point2& place) noexcept {
    const auto [low, high] = std::minmax(s.lo.y, s.hi.y);
    if (place.x < s.lo.x || place.x > s.hi.x || place.y < low || place.y > high)
        return false;
    const Vector way = from_to(s.lo, s.hi);
    const Wide twice = 2 * cross(way, from_to(s.lo, place));
    const Wide reach = Wide{way.x} + (way.y < 0 ? -way.y : way.y);
    // The corners at either end of the borders that belong to the square do not, but for the one between
    // them.
    return -reach < twice && (twice < reach || (twice == reach && way.y < 0));
}

/// Places, no two of them the same, sorted into cells; those of a cell that has many into cells of its own:
/// where sides run through one point, crossings of all pairs lie close together.
class Places {
  public:
    explicit Places(std::vector<Point2> places)
        : places_(std::move(places)), size_(cell_size(places_)), cells_(box_of(places_), size_) {
        const NumbersBelow numbers{static_cast<std::uint32_t>(places_.size())};
        [[maybe_unused]] const bool sorted =
            cells_.sort(numbers, places_.size(),
                        [this](std::uint32_t i, const auto& visit) { visit(cells_.cell(places_[i])); });
        assert(sorted); // each place is in one cell
        if (size_ <= least_size)
            return;
        for (std::size_t cell = 0; cell < cells_.cells(); ++cell) {
            const std::span<const std::uint32_t> within = cells_.in_cell(cell);
            if (within.size() < crowd)
                continue;
            std::vector<Point2> crowded;
            for (const std::uint32_t i : within)
                crowded.push_back(places_[i]);
            crowded_cells_.push_back(cell);
            crowds_.emplace_back(std::move(crowded));
        }
    }

    /// Calls visit(place) for those, but for the ends of the segment, for which `on(segment, place)`; they
    /// lie within a unit of it.
    template <class On, class Visit>
    void for_places_on(const Segment& s, const On& on, const Visit& visit) const {
        cells_.for_cells_along(s, [&](std::size_t cell) {
            const std::span<const std::uint32_t> within = cells_.in_cell(cell);
            if (within.size() >= crowd && size_ > least_size) {
                const auto found = std::lower_bound(crowded_cells_.begin(), crowded_cells_.end(), cell);
                assert(found != crowded_cells_.end() && *found == cell);
                crowds_[static_cast<std::size_t>(found - crowded_cells_.begin())].for_places_on(s, on, visit);
                return;
            }
            for (const std::uint32_t i : within) {
                const Point2& place = places_[i];
                if (place != s.lo && place != s.hi && on(s, place))
                    visit(place);
            }
        });
    }

  private:
    static constexpr std::size_t crowd = 128;
    /// Of cells so large that a segment's margin covers the unit squares into which it comes.
    static constexpr double least_size = 1 / Grid::margin;

    static double cell_size(std::span<const Point2> places) {
        return std::max(least_size, Grid::cell_size(box_of(places), static_cast<double>(places.size()), 0));
    }

    std::vector<Point2> places_;
    double size_;
    Grid cells_;
    std::vector<std::size_t> crowded_cells_; ///< ascending
    std::vector<Places> crowds_;             ///< of each of them
};

Places distinct(std::vector<Point2> places) {
    std::sort(places.begin(), places.end());
    places.erase(std::unique(places.begin(), places.end()), places.end());
    return Places(std::move(places));
}

void add_ends(std::span<const Side> sides, std::vector<Point2>& places) {
    for (const Side& side : sides)
        places.insert(places.end(), {side.line.lo, side.line.hi});
}

void add_crossings(std::span<const Side> sides, std::vector<Point2>& places) {
    Layer layer; // every side an open chain
    std::vector<Point2> points;
    for (const Side& side : sides) {
        points.insert(points.end(), {side.line.lo, side.line.hi});
        layer.offsets.push_back(points.size());
    }
    layer.points = PointArray(std::move(points));
    for (const Crossing& crossing : find_crossings(layer, std::numeric_limits<std::size_t>::max()).first)
        places.push_back(crossing_place(sides[crossing.contour_a].line, sides[crossing.contour_b].line));
}

/// Cuts the sides at those of the places for which `on(segment, place)`. Whether there was anything to cut.
template <class On>
bool cut(Arrangement& arrangement, const Places& places, const On& on) {
    std::vector<Side>& sides = arrangement.sides;
    std::vector<Side> pieces;
    std::vector<Point2> cuts;
    const auto add_piece = [&](const Point2& a, const Point2& b, const SideCount& step) {
        assert(a != b);
        if (a < b)
            pieces.push_back({.line = {a, b}, .step = step});
        else
            pieces.push_back({.line = {b, a}, .step = -1 * step}); // turned upright
    };
    for (Side& side : sides) {
        cuts.clear();
        places.for_places_on(side.line, on, [&](const Point2& place) { cuts.push_back(place); });
        if (cuts.empty())
            continue;
        // In the order in which it comes into their squares.
        const bool falls = side.line.hi.y < side.line.lo.y;
        std::sort(cuts.begin(), cuts.end(), [&](const Point2& a, const Point2& b) {
            return a.x != b.x ? a.x < b.x : falls ? a.y > b.y : a.y < b.y;
        });
        Point2 from = side.line.lo;
        for (const Point2& place : cuts) {
            add_piece(from, place, side.step);
            from = place;
        }
        add_piece(from, side.line.hi, side.step);
        side.step = {};
    }
    if (pieces.empty())
        return false;
    sides.insert(sides.end(), pieces.begin(), pieces.end());
    merge(arrangement);
    return true;
}

/// Finds what is below each side, by a sweep from left to right. The sides meet in their ends only.
void wind(Arrangement& arrangement) {
    std::vector<Side>& sides = arrangement.sides;
    const SideCount around{arrangement.around, 0};
    std::vector<Segment> lines;
    lines.reserve(sides.size());
    for (const Side& side : sides)
        lines.push_back(side.line);
    std::vector<std::uint32_t> next_corner(sides.size(), 0);
    // The line of a side over a place that the sweep has come to, and did not before.
    const auto along = [&arrangement, &next_corner](std::uint32_t i, const Point2& at) -> Segment {
        const Side& side = arrangement.sides[i];
        const std::span<const Corner> corners = arrangement.corners_of(side);
        std::uint32_t& next = next_corner[i];
        while (next < corners.size() && corners[next].place <= at)
            ++next;
        return {next == 0 ? side.line.lo : corners[next - 1].place,
                next == corners.size() ? side.line.hi : corners[next].place};
    };
    SweepStatus status(lines, along);
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
        const double step = off(side.below) - off(side.above());
        Point2 from = side.line.lo;
        const auto go_on_to = [&](const Point2& to) {
            length += distance(from, to);
            excess += step * (to.x - from.x) * (from.y + to.y) / 2;
            from = to;
        };
        for (const Corner& corner : arrangement.corners_of(side))
            go_on_to(corner.place);
        go_on_to(side.line.hi);
    }
    return std::abs(excess) <= 2 * length;
}

} // namespace

Arrangement arranged(std::span<const WoundRing> rings, const Windings& around, const ClippingGrid& grid) {
    Uncut uncut(rings, grid);
    Arrangement arrangement = std::move(uncut.arrangement);
    if (!arrangement.sides.empty()) {
        std::vector<Point2> hot;
        add_ends(arrangement.sides, hot);
        add_crossings(arrangement.sides, hot);
        if (cut(arrangement, distinct(std::move(hot)), comes_into) && !arrangement.sides.empty()) {
            // What was bent may run through ends that it did not come near to.
            std::vector<Point2> ends;
            add_ends(arrangement.sides, ends);
            cut(arrangement, distinct(std::move(ends)), [](const Segment& s, const Point2& place) {
                return s.lo < place && place < s.hi && side(s, place) == 0;
            });
        }
    }
    arrangement.sides.insert(arrangement.sides.end(), uncut.alone.begin(), uncut.alone.end());
    arrangement.around = around;
    wind(arrangement);
    return arrangement;
}

bool Arrangement::bounded_by_all(const Material& material) const {
    return bounds(*this, material, [](const SideCount& count) { return count.windings.sum(); });
}

bool Arrangement::bounded_by_rest(const Material& material) const {
    return bounds(*this, material, [](const SideCount& count) { return count.left; });
}

} // namespace lamella
