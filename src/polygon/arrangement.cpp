#include "polygon/arrangement.hpp"

#include "lamella/core/error.hpp"

#include "contour/distance.hpp"
#include "contour/grid.hpp"
#include "polygon/close_sides.hpp"
#include "polygon/crossing_pairs.hpp"
#include "polygon/open_runs.hpp"
#include "polygon/orientation.hpp"
#include "polygon/segment_sweep.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// Adds up coincident sides.
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

/// Largest distance at which sides can be drawn to another side when these are cut: each end and each piece
/// moves by less than the diagonal of a unit square.
constexpr double reach_of_cuts = 4;
/// The same if sides were joined to bundles before; see `join_bundles`.
constexpr double reach_of_bundles = 12;

/// The sides of rings before they are cut.
class Uncut {
  public:
    /// `reach` is the distance below which sides count as close.
    Uncut(std::span<const RingWithWinding> rings, const ClippingGrid& grid, double reach) {
        std::vector<Point2> positions;
        for (const RingWithWinding& ring : rings) {
            for (const Point2& p : ring.points)
                positions.push_back(grid.position(p));
            layer_.offsets.push_back(positions.size());
        }
        layer_.rings = rings.size();
        layer_.points = PointArray(std::move(positions));
        close_ = close_sides(layer_, reach);
        OpenRuns runs;
        for (std::size_t i = 0; i < rings.size(); ++i)
            add(rings[i], i, runs);
        arrangement.crossed = std::move(runs).crossed();
        merge(arrangement);
    }

    Arrangement arrangement; ///< sides that may come close to others
    std::vector<Side> alone; ///< all other sides

  private:
    void add(const RingWithWinding& ring, std::size_t number, OpenRuns& runs) {
        const std::span<const Point2> positions = layer_.contour(number);
        const std::size_t n = positions.size();
        const SideCount step{ring.turn, ring.left};
        const auto after = [n](std::size_t i) {
            return i + 1 < n ? i + 1 : 0;
        };
        const auto close = [&](std::size_t i) -> bool {
            return close_[layer_.offsets[number] + i];
        };
        const auto rightwards = [&](std::size_t i) {
            return positions[i] < positions[after(i)];
        };
        for (std::size_t i = 0; i < n;) {
            arrangement.end_corners.push_back({positions[i], ring.points[i]});
            if (close(i)) {
                if (i == 0 || !close(i - 1))
                    runs.begin(ring.points[i]);
                runs.go_on_to(ring.points[after(i)]);
                if (positions[i] != positions[after(i)])
                    arrangement.sides.push_back({.line = segment_between(positions[i], positions[after(i)]),
                                                 .step = (rightwards(i) ? 1 : -1) * step});
                ++i;
                continue;
            }
            std::size_t last = i; // last of the sides with the same x-direction
            while (last + 1 < n && !close(last + 1) && rightwards(last + 1) == rightwards(i))
                ++last;
            const auto first = static_cast<std::uint32_t>(arrangement.corners.size());
            for (std::size_t k = i + 1; k <= last; ++k) {
                const std::size_t corner = rightwards(i) ? k : last + 1 + i - k;
                arrangement.corners.push_back({positions[corner], ring.points[corner]});
            }
            alone.push_back({.line = segment_between(positions[i], positions[after(last)]),
                             .step = (rightwards(i) ? 1 : -1) * step,
                             .alone = true,
                             .first = first,
                             .corners = static_cast<std::uint32_t>(last - i)});
            i = last + 1;
        }
    }

    Layer layer_; ///< points are grid positions
    std::vector<bool> close_;
};

// Snap rounding (Hobby 1999; Guibas and Marimont 1998). Unit squares around the grid positions tile the
// plane. Each square includes its lower and its left border. A square is hot if sides end or cross in it, and
// each side is drawn to the centres of all hot squares that it enters. Sides may then coincide, but never
// cross: they did not cross outside of hot squares, and each square shrinks to its centre. This holds if all
// given sides are tested at once and exactly; sides that are bent first and then tested again may drift from
// position to position.

__extension__ using Wide = __int128;

/// Converts a difference of positions, at most 2^38.
std::int64_t whole(double number) noexcept {
    return static_cast<std::int64_t>(number);
}

struct GridVector {
    std::int64_t x;
    std::int64_t y;
};

GridVector from_to(const Point2& a, const Point2& b) noexcept {
    return {whole(b.x - a.x), whole(b.y - a.y)};
}

Wide cross(const GridVector& a, const GridVector& b) noexcept {
    return Wide{a.x} * b.y - Wide{a.y} * b.x;
}

/// Returns the position in whose square two sides cross properly.
Point2 crossing_point(const Segment& a, const Segment& b) noexcept {
    const GridVector u = from_to(a.lo, a.hi);
    const GridVector v = from_to(b.lo, b.hi);
    Wide of = cross(u, v);
    Wide share = cross(from_to(a.lo, b.lo), v); // fraction of u up to the crossing, times `of`
    if (of < 0) {
        of = -of;
        share = -share;
    }
    assert(of > 0 && share > 0 && share < of);
    const auto nearest = [&](std::int64_t way) { // rounds halves upwards
        const Wide twice = 2 * share * way + of;
        const Wide floor = twice / (2 * of) - (twice % (2 * of) < 0 ? 1 : 0);
        return static_cast<double>(static_cast<std::int64_t>(floor));
    };
    return {a.lo.x + nearest(u.x), a.lo.y + nearest(u.y)};
}

/// Returns whether a side enters the square of a position that is not one of its ends.
bool comes_into(const Segment& s, const Point2& position) noexcept {
    const auto [low, high] = std::minmax(s.lo.y, s.hi.y);
    if (position.x < s.lo.x || position.x > s.hi.x || position.y < low || position.y > high)
        return false;
    const GridVector way = from_to(s.lo, s.hi);
    const Wide twice = 2 * cross(way, from_to(s.lo, position));
    const Wide reach = Wide{way.x} + (way.y < 0 ? -way.y : way.y);
    // The end points of the two included borders are not part of the square, except their common point.
    return -reach < twice && (twice < reach || (twice == reach && way.y < 0));
}

/// Distinct positions, sorted into cells. Cells with many positions are divided again: where sides run
/// through one point, the crossings of all pairs lie close together.
class Positions {
  public:
    explicit Positions(std::vector<Point2> positions)
        : positions_(std::move(positions)), size_(cell_size(positions_)), cells_(box_of(positions_), size_) {
        const NumbersBelow numbers{static_cast<std::uint32_t>(positions_.size())};
        [[maybe_unused]] const bool sorted =
            cells_.sort(numbers, positions_.size(),
                        [this](std::uint32_t i, const auto& visit) { visit(cells_.cell(positions_[i])); });
        assert(sorted); // each position is in one cell
        if (size_ <= least_size)
            return;
        for (std::size_t cell = 0; cell < cells_.cells(); ++cell) {
            const std::span<const std::uint32_t> within = cells_.in_cell(cell);
            if (within.size() < crowd)
                continue;
            std::vector<Point2> full;
            for (const std::uint32_t i : within)
                full.push_back(positions_[i]);
            full_cells_.push_back(cell);
            crowds_.emplace_back(std::move(full));
        }
    }

    /// Calls visit(position) for each position with `on(segment, position)`, except the ends of the segment;
    /// they lie within two units of it.
    template <class On, class Visit>
    void for_points_on(const Segment& s, const On& on, const Visit& visit) const {
        cells_.for_cells_along(s.lo, s.hi, [&](std::size_t cell) {
            const std::span<const std::uint32_t> within = cells_.in_cell(cell);
            if (within.size() >= crowd && size_ > least_size) {
                const auto found = std::lower_bound(full_cells_.begin(), full_cells_.end(), cell);
                assert(found != full_cells_.end() && *found == cell);
                crowds_[static_cast<std::size_t>(found - full_cells_.begin())].for_points_on(s, on, visit);
                return;
            }
            for (const std::uint32_t i : within) {
                const Point2& position = positions_[i];
                if (position != s.lo && position != s.hi && on(s, position))
                    visit(position);
            }
        });
    }

  private:
    static constexpr std::size_t crowd = 128;
    /// Size of cells at which a segment's margin covers the unit squares that the segment enters, and their
    /// neighbours.
    static constexpr double least_size = 2 / Grid::margin;

    static double cell_size(std::span<const Point2> positions) {
        return std::max(least_size,
                        Grid::cell_size(box_of(positions), static_cast<double>(positions.size()), 0));
    }

    std::vector<Point2> positions_;
    double size_;
    Grid cells_;
    std::vector<std::size_t> full_cells_; ///< ascending
    std::vector<Positions> crowds_;       ///< one for each full cell
};

Positions distinct(std::vector<Point2> positions) {
    std::sort(positions.begin(), positions.end());
    positions.erase(std::unique(positions.begin(), positions.end()), positions.end());
    return Positions(std::move(positions));
}

void add_ends(std::span<const Side> sides, std::vector<Point2>& positions) {
    for (const Side& side : sides)
        positions.insert(positions.end(), {side.line.lo, side.line.hi});
}

static_assert(bytes_of_crossing == 4 * sizeof(Side) + 8 * sizeof(Point2));

using CrossingPairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

/// Returns all crossings; if there are more than `most`, any number above `most` of them.
CrossingPairs crossings_of(std::span<const Side> sides, std::uint64_t most, const LayerBudget& budget) {
    std::vector<Segment> lines;
    lines.reserve(sides.size());
    for (const Side& side : sides)
        lines.push_back(side.line);
    return crossing_pairs(lines, most, budget);
}

/// Number of crossings and cuts above which a layer is treated as exceptional.
std::uint64_t many(std::span<const Side> sides) noexcept {
    return 16 * sides.size() + 65536;
}

/// Sides that lie within 1.5 units of the longest of them, between its ends. Their own ends are on it.
struct Bundle {
    /// The count between a position and the next one, minus the count before.
    struct Step {
        SideCount step;
        std::int64_t forth = 0; ///< sum of the positive `left` of the steps; `back` that of the negative ones
        std::int64_t back = 0;
    };
    std::vector<Point2> positions;
    std::vector<Step> steps;

    void add(std::size_t first, std::size_t last, SideCount step) {
        if (last < first)
            return add(last, first, -1 * step);
        steps[first].step += step;
        steps[last].step += -1 * step;
        std::int64_t Step::*const way = step.left > 0 ? &Step::forth : &Step::back;
        steps[first].*way += step.left;
        steps[last].*way -= step.left;
    }
};

constexpr double reach_of_bundle = 1.5;

bool is_beside(const Segment& s, const Point2& position) noexcept {
    const GridVector way = from_to(s.lo, s.hi);
    const GridVector to = from_to(s.lo, position);
    const Wide along = Wide{way.x} * to.x + Wide{way.y} * to.y;
    const Wide squared = Wide{way.x} * way.x + Wide{way.y} * way.y;
    return along > 0 && along < squared &&
           std::abs(static_cast<double>(cross(way, to))) <=
               reach_of_bundle * std::sqrt(static_cast<double>(squared));
}

/// Bundles nearly collinear sides. If thousands of sides lie on one line except for rounding to the grid,
/// each crosses most of the others at arbitrary points. Each side is led through those ends of other sides
/// that lie beside it, so that coincident sides add up as in `join_collinear`. A side moves by at most twice
/// the reach of a bundle and its ends do not move, so rings stay closed. O(n log n) for n sides in few
/// bundles; a number of cuts for each side in the worst case.
void join_bundles(Arrangement& arrangement, const LayerBudget& budget) {
    std::vector<Side>& sides = arrangement.sides;
    if (sides.empty())
        return; // opposite sides have cancelled
    const auto squared_length = [](const Side& side) {
        const GridVector way = from_to(side.line.lo, side.line.hi);
        return Wide{way.x} * way.x + Wide{way.y} * way.y;
    };
    std::sort(sides.begin(), sides.end(), [&](const Side& a, const Side& b) {
        const Wide length_a = squared_length(a);
        const Wide length_b = squared_length(b);
        return length_a != length_b ? length_a > length_b
                                    : std::tie(a.line.lo, a.line.hi) < std::tie(b.line.lo, b.line.hi);
    });
    std::vector<Point2> ends;
    add_ends(sides, ends);
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    const Positions positions = distinct(ends);
    struct Seat {
        std::uint32_t bundle;
        std::uint32_t position;
    };
    std::vector<std::vector<Seat>> seats(ends.size()); // of each end, by ascending bundles
    const auto seats_of = [&](const Point2& end) -> std::vector<Seat>& {
        return seats[static_cast<std::size_t>(std::lower_bound(ends.begin(), ends.end(), end) -
                                              ends.begin())];
    };
    std::vector<Bundle> bundles;
    const std::uint64_t most = many(sides);
    std::uint64_t cuts = 0;
    for (const Side& side : sides) {
        budget.check();
        const Point2 lo = side.line.lo; // clang 14 captures no structured binding
        const Point2 hi = side.line.hi;
        const std::vector<Seat>& low = seats_of(lo);
        const std::vector<Seat>& high = seats_of(hi);
        const std::vector<Seat>& fewer = low.size() <= high.size() ? low : high;
        const std::vector<Seat>& others = low.size() <= high.size() ? high : low;
        bool joined = false;
        for (const Seat& seat : fewer) {
            const auto other =
                std::lower_bound(others.begin(), others.end(), seat,
                                 [](const Seat& a, const Seat& b) { return a.bundle < b.bundle; });
            if (other == others.end() || other->bundle != seat.bundle)
                continue;
            const bool seat_is_low = &fewer == &low;
            bundles[seat.bundle].add(seat_is_low ? seat.position : other->position,
                                     seat_is_low ? other->position : seat.position, side.step);
            joined = true;
            break;
        }
        if (joined)
            continue;
        const auto number = static_cast<std::uint32_t>(bundles.size());
        Bundle& bundle = bundles.emplace_back();
        if (cuts <= most)
            positions.for_points_on(side.line, is_beside,
                                    [&](const Point2& position) { bundle.positions.push_back(position); });
        cuts += bundle.positions.size();
        const GridVector way = from_to(lo, hi);
        const auto along = [&](const Point2& position) {
            const GridVector to = from_to(lo, position);
            return Wide{way.x} * to.x + Wide{way.y} * to.y;
        };
        std::sort(bundle.positions.begin(), bundle.positions.end(), [&](const Point2& a, const Point2& b) {
            const Wide along_a = along(a);
            const Wide along_b = along(b);
            return along_a != along_b ? along_a < along_b : a < b;
        });
        bundle.positions.insert(bundle.positions.begin(), lo);
        bundle.positions.push_back(hi);
        bundle.steps.resize(bundle.positions.size());
        bundle.add(0, bundle.positions.size() - 1, side.step);
        for (std::uint32_t i = 0; i < bundle.positions.size(); ++i)
            seats_of(bundle.positions[i]).push_back({number, i});
    }
    sides.clear();
    for (const Bundle& bundle : bundles) {
        Bundle::Step here;
        for (std::size_t i = 0; i + 1 < bundle.positions.size(); ++i) {
            here.step += bundle.steps[i].step;
            here.forth += bundle.steps[i].forth;
            here.back += bundle.steps[i].back;
            arrangement.walls = arrangement.walls || (here.forth > 0 && here.back < 0);
            const Point2& a = bundle.positions[i];
            const Point2& b = bundle.positions[i + 1];
            if (here.step != SideCount{})
                sides.push_back({.line = segment_between(a, b), .step = (a < b ? 1 : -1) * here.step});
        }
    }
    merge(arrangement);
}

/// A line through grid positions. Sides on it have exactly the same one.
struct CarryingLine {
    GridVector direction; ///< from left to right, reduced to lowest terms
    Wide height;          ///< cross product of the direction with any position of the line

    explicit CarryingLine(const Segment& s) noexcept : direction(from_to(s.lo, s.hi)) {
        const std::int64_t divisor = std::gcd(direction.x, direction.y);
        direction = {direction.x / divisor, direction.y / divisor};
        height = cross(direction, {whole(s.lo.x), whole(s.lo.y)});
    }
    [[nodiscard]] auto key() const noexcept { return std::tie(direction.x, direction.y, height); }
};

/// Cuts sides that overlap on one line at one another's ends and adds up the coincident pieces, so that n
/// sides become at most 2 n pieces. Cut one by one, each side would be cut at every end within it.
void join_collinear(Arrangement& arrangement) {
    struct End {
        CarryingLine line;
        Point2 at;
        SideCount step;
        bool begins;
    };
    std::vector<End> ends;
    ends.reserve(2 * arrangement.sides.size());
    for (const Side& side : arrangement.sides) {
        const CarryingLine line(side.line);
        ends.push_back({line, side.line.lo, side.step, true});
        ends.push_back({line, side.line.hi, side.step, false});
    }
    std::sort(ends.begin(), ends.end(), [](const End& a, const End& b) {
        return a.line.key() != b.line.key() ? a.line.key() < b.line.key() : a.at < b.at;
    });
    std::vector<Side> sides;
    SideCount here; // sum over the sides up to the next end
    std::int64_t forth = 0;
    std::int64_t back = 0;
    std::size_t open = 0;
    for (std::size_t i = 0; i < ends.size(); ++i) {
        const End& end = ends[i];
        const std::int64_t sign = end.begins ? 1 : -1;
        here += sign * end.step;
        (end.step.left > 0 ? forth : back) += sign * end.step.left;
        open += static_cast<std::size_t>(sign);
        if (open == 0 || ends[i + 1].at == end.at)
            continue;
        arrangement.walls = arrangement.walls || (forth > 0 && back < 0);
        if (here != SideCount{})
            sides.push_back({.line = {end.at, ends[i + 1].at}, .step = here});
    }
    arrangement.sides = std::move(sides);
}

/// Pieces of sides. Most coincident pieces are made shortly after one another and are added up at once:
/// thousands of sides that run along one another take no more memory than their sums.
class Pieces {
  public:
    explicit Pieces(std::size_t sides) : last_(std::bit_ceil(4 * sides + 1024), none) {}

    void add(const Point2& a, const Point2& b, const SideCount& step) {
        assert(a != b);
        if (b < a)
            return add(b, a, -1 * step); // reversed to run from left to right
        std::uint32_t& last = last_[hash(a, b) & (last_.size() - 1)];
        std::vector<Side>& sides = all_.sides;
        if (last != none && sides[last].line.lo == a && sides[last].line.hi == b) {
            all_.walls = all_.walls || sides[last].step.left * step.left < 0;
            sides[last].step += step;
        } else {
            last = static_cast<std::uint32_t>(sides.size());
            sides.push_back({.line = {a, b}, .step = step});
        }
    }
    [[nodiscard]] const Arrangement& all() const noexcept { return all_; }

  private:
    static constexpr std::uint32_t none = 0xffffffff;

    static std::size_t hash(const Point2& a, const Point2& b) noexcept {
        std::uint64_t bits = 0;
        for (const double number : {a.x, a.y, b.x, b.y})
            bits = (bits ^ static_cast<std::uint64_t>(whole(number))) * 0x9e3779b97f4a7c15U;
        return bits ^ (bits >> 32);
    }

    Arrangement all_;
    std::vector<std::uint32_t> last_; ///< by hash: the index of the piece that was added last
};

/// Cuts the sides at the positions for which `on(segment, position)` is true. Returns false without cutting
/// if that takes more than `most` cuts.
template <class On>
bool try_to_cut(Arrangement& arrangement, const Positions& positions, const On& on, std::uint64_t most,
                bool& any, const LayerBudget& budget) {
    std::vector<Side>& sides = arrangement.sides;
    Pieces pieces(sides.size());
    std::vector<std::uint32_t> cut;
    std::vector<Point2> cuts;
    std::uint64_t made = 0;
    for (std::uint32_t i = 0; i < sides.size(); ++i) {
        const Side& side = sides[i];
        budget.check();
        cuts.clear();
        positions.for_points_on(side.line, on, [&](const Point2& position) { cuts.push_back(position); });
        if (cuts.empty())
            continue;
        made += cuts.size() + 1;
        if (made > most)
            return false;
        // In the order in which the side enters their squares.
        const bool falls = side.line.hi.y < side.line.lo.y;
        std::sort(cuts.begin(), cuts.end(), [&](const Point2& a, const Point2& b) {
            return a.x != b.x ? a.x < b.x : falls ? a.y > b.y : a.y < b.y;
        });
        Point2 from = side.line.lo;
        for (const Point2& position : cuts) {
            pieces.add(from, position, side.step);
            from = position;
        }
        pieces.add(from, side.line.hi, side.step);
        cut.push_back(i);
        budget.need(pieces.all().sides.size(), 2 * sizeof(Side), "pieces of contours");
    }
    any = !cut.empty();
    if (!any)
        return true;
    for (const std::uint32_t i : cut)
        sides[i].step = {};
    sides.insert(sides.end(), pieces.all().sides.begin(), pieces.all().sides.end());
    arrangement.walls = arrangement.walls || pieces.all().walls;
    merge(arrangement);
    return true;
}

/// Number of pieces that take some ten seconds.
constexpr std::uint64_t most_pieces = std::uint64_t{1} << 27;

/// Returns whether any side was cut.
template <class On>
bool cut(Arrangement& arrangement, const Positions& positions, const On& on, const LayerBudget& budget) {
    bool any = false;
    if (try_to_cut(arrangement, positions, on, many(arrangement.sides), any, budget))
        return any;
    join_collinear(arrangement); // makes cuts that are needed anyway
    if (!try_to_cut(arrangement, positions, on, most_pieces, any, budget))
        throw Error(
            ErrorKind::limit,
            fmt::format("{}: many contours run along one another, closer than coordinates are "
                        "rounded: cut at one another's corners they make more than {} pieces, the limit",
                        budget.layer(), most_pieces));
    return true;
}

/// Finds the counts below each side by a sweep from left to right. The sides meet only at their ends.
void wind(Arrangement& arrangement, const LayerBudget& budget) {
    std::vector<Side>& sides = arrangement.sides;
    const SideCount around{arrangement.around, 0};
    std::vector<Segment> lines;
    lines.reserve(sides.size());
    for (const Side& side : sides)
        lines.push_back(side.line);
    std::vector<std::uint32_t> next_corner(sides.size(), 0);
    // Returns the segment of a side over a position of the sweep. Positions must ascend.
    const auto along = [&arrangement, &next_corner](std::uint32_t i, const Point2& at) -> Segment {
        const Side& side = arrangement.sides[i];
        const std::span<const Corner> corners = arrangement.corners_of(side);
        std::uint32_t& next = next_corner[i];
        while (next < corners.size() && corners[next].position <= at)
            ++next;
        return {next == 0 ? side.line.lo : corners[next - 1].position,
                next == corners.size() ? side.line.hi : corners[next].position};
    };
    SweepStatus status(lines, along);
    const std::vector<SweepEvent> events = sweep_events(lines, SweepOrder::ends_first);
    for (auto event = events.begin(); event != events.end();) {
        if (!event->begins) {
            status.erase(event->segment);
            ++event;
            continue;
        }
        budget.check();
        // Sides that begin at one point are inserted together, as each takes its count from the one below.
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

/// Returns whether rings bound the material, up to areas that rounding to the grid can create. `winding`
/// returns how many times the rings wind around a point.
template <class Winding>
bool bounds(const Arrangement& arrangement, const Material& material, const Winding& winding) {
    double excess = 0; // integral of the deviation from the material
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
            go_on_to(corner.position);
        go_on_to(side.line.hi);
    }
    return std::abs(excess) <= 2 * length;
}

} // namespace

Arrangement arranged(std::span<const RingWithWinding> rings, const Windings& around, const ClippingGrid& grid,
                     const LayerBudget& budget, const CrossingLimit& most, Bundles bundles) {
    std::optional<Uncut> uncut(std::in_place, rings, grid, reach_of_cuts);
    CrossingPairs pairs;
    if (bundles == Bundles::when_many)
        pairs = crossings_of(uncut->arrangement.sides, many(uncut->arrangement.sides), budget);
    const std::uint64_t room = budget.room(bytes_of_crossing);
    if (bundles == Bundles::always || pairs.size() > many(uncut->arrangement.sides)) {
        uncut.emplace(rings, grid, reach_of_bundles);
        join_bundles(uncut->arrangement, budget);
        pairs = crossings_of(uncut->arrangement.sides, std::min(most(uncut->arrangement.sides.size()), room),
                             budget);
    }
    if (const std::size_t sides = uncut->arrangement.sides.size();
        pairs.size() > most(sides) && most(sides) <= room)
        refuse_crossings(sides, budget, most);
    budget.need(pairs.size(), bytes_of_crossing, "crossings of contours, or more,");
    Arrangement arrangement = std::move(uncut->arrangement);
    if (!arrangement.sides.empty()) {
        std::vector<Point2> hot;
        add_ends(arrangement.sides, hot);
        for (const auto& [a, b] : pairs)
            hot.push_back(crossing_point(arrangement.sides[a].line, arrangement.sides[b].line));
        if (cut(arrangement, distinct(std::move(hot)), comes_into, budget) && !arrangement.sides.empty()) {
            // A bent side may run through ends that it was not close to before.
            std::vector<Point2> ends;
            add_ends(arrangement.sides, ends);
            cut(
                arrangement, distinct(std::move(ends)),
                [](const Segment& s, const Point2& position) {
                    return s.lo < position && position < s.hi && side(s, position) == 0;
                },
                budget);
        }
    }
    arrangement.sides.insert(arrangement.sides.end(), uncut->alone.begin(), uncut->alone.end());
    arrangement.around = around;
    wind(arrangement, budget);
    return arrangement;
}

bool Arrangement::bounded_by_all(const Material& material) const {
    return bounds(*this, material, [](const SideCount& count) { return count.windings.sum(); });
}

bool Arrangement::bounded_by_rest(const Material& material) const {
    return bounds(*this, material, [](const SideCount& count) { return count.left; });
}

} // namespace lamella
