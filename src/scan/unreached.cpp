#include "scan/unreached.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
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
#include <functional>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

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

/// A side of a ring: its direction, of length 1, and its length.
struct Side {
    Side(const Point2& a, const Point2& b) noexcept : way{b.x - a.x, b.y - a.y} {
        length = std::sqrt(way.x * way.x + way.y * way.y);
        if (length > 0)
            way = {way.x / length, way.y / length};
    }

    Point2 way;
    double length;
};

double cross(const Point2& a, const Point2& b) noexcept {
    return a.x * b.y - a.y * b.x;
}
double dot_product(const Point2& a, const Point2& b) noexcept {
    return a.x * b.x + a.y * b.y;
}

/// Appends the piece that fills the gap between the strips beside two sides that meet at p.
void add_corner(const Point2& p, const Side& before, const Side& after, double reach, Reached& reached) {
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

/// Returns the rings of the layer that are among `wanted`.
Layer rings_of(const Layer& layer, std::vector<std::uint32_t> wanted) {
    std::sort(wanted.begin(), wanted.end());
    LayerBuilder some;
    for (const std::uint32_t ring : wanted)
        some.add_contour(layer.contour(ring), true);
    return some.finish(layer.index, layer.z, layer.bottom, layer.top);
}

std::vector<std::uint32_t> rings_of(const Polygon& body) {
    std::vector<std::uint32_t> rings{body.outer};
    rings.insert(rings.end(), body.holes.begin(), body.holes.end());
    return rings;
}

/// The rings of an inset, which are found by their first points.
class InsetRings {
  public:
    InsetRings(const Layer& inset, double by)
        : inset_(inset), by_(by), tolerance_(by * 1e-5), taken_(inset.rings, false) {}

    /// Returns whether the inset has the ring with its sides moved inwards, and takes it from the inset. No
    /// corner may be sharp. Sides of rounded corners may be missing, where others meet before them.
    [[nodiscard]] bool take(std::span<const Point2> ring) {
        if (ring.size() < 3 || !move(ring))
            return false;
        const Box2 box = box_of(ring).grown(reached_mitre * by_);
        std::size_t begin = 0; // rings in normal form are ordered by their first points
        std::size_t count = inset_.rings;
        while (count > 0) {
            const std::size_t half = count / 2;
            if (inset_.contour(begin + half).front().x < box.x0) {
                begin += half + 1;
                count -= half + 1;
            } else {
                count = half;
            }
        }
        for (; begin < inset_.rings && inset_.contour(begin).front().x <= box.x1; ++begin)
            if (!taken_[begin] && box.meets(Box2::of(inset_.contour(begin).front())) &&
                is_moved(inset_.contour(begin)))
                return taken_[begin] = true;
        return false;
    }
    /// Returns the rings that were not taken.
    [[nodiscard]] Layer others() const {
        std::vector<std::uint32_t> others;
        for (std::uint32_t i = 0; i < inset_.rings; ++i)
            if (!taken_[i])
                others.push_back(i);
        return rings_of(inset_, std::move(others));
    }
    [[nodiscard]] bool all_taken() const {
        return std::find(taken_.begin(), taken_.end(), false) == taken_.end();
    }

  private:
    /// The line of a moved side: the points p with cross(way, p) = level.
    struct MovedSide {
        Point2 way;
        double level;
    };

    bool move(std::span<const Point2> ring) {
        sides_.clear();
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const Side side(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]);
            if (!(side.length > 0))
                return false;
            sides_.push_back({side.way, cross(side.way, ring[i]) + by_});
        }
        return true;
    }
    [[nodiscard]] bool is_moved(std::span<const Point2> ring) const {
        for (std::size_t first = 0; ring.size() <= sides_.size() && first < sides_.size(); ++first)
            if (has(ring, 0, first) && follows(ring, first))
                return true;
        return false;
    }
    /// Returns whether side i of the ring lies on a moved side.
    [[nodiscard]] bool has(std::span<const Point2> ring, std::size_t i, std::size_t moved) const {
        const Point2& a = ring[i];
        const Point2& b = ring[i + 1 == ring.size() ? 0 : i + 1];
        const auto& [way, level] = sides_[moved];
        return std::abs(cross(way, a) - level) <= tolerance_ &&
               std::abs(cross(way, b) - level) <= tolerance_ && dot_product(way, {b.x - a.x, b.y - a.y}) > 0;
    }
    /// Returns whether the sides of the ring are those moved, in their order, if its side 0 is `first`.
    [[nodiscard]] bool follows(std::span<const Point2> ring, std::size_t first) const {
        const std::size_t all = sides_.size();
        std::size_t before = first;
        for (std::size_t i = 1; i <= ring.size(); ++i) {
            std::size_t next = before + 1;
            const auto here = [&] {
                return i == ring.size() ? next == first + all : has(ring, i, next % all);
            };
            while (!here()) // the side is missing
                if (!turns_left(next - 1, next) || ++next > first + all)
                    return false;
            if (!is_reached_corner(before, next))
                return false;
            before = next;
        }
        return true;
    }
    [[nodiscard]] bool turns_left(std::size_t side, std::size_t next) const {
        constexpr double straight = -1e-6;
        return cross(sides_[side % sides_.size()].way, sides_[next % sides_.size()].way) >= straight;
    }
    /// Returns whether the ring reaches the corner between the lines of two sides, and what the sides between
    /// them leave of it.
    [[nodiscard]] bool is_reached_corner(std::size_t side, std::size_t next) const {
        constexpr double sharpest = -0.8660254; // the cosine of 180 - 30 degrees
        const Point2& one = sides_[side % sides_.size()].way;
        const Point2& other = sides_[next % sides_.size()].way;
        if (next == side + 1)
            return cross(one, other) < 0 || dot_product(one, other) > sharpest;
        return turns_left(next - 1, next) && cross(one, other) >= 0 && dot_product(one, other) > sharpest;
    }

    const Layer& inset_;
    double by_;
    double tolerance_;
    std::vector<bool> taken_;
    std::vector<MovedSide> sides_; // of the ring that is looked for
};

/// The interval of a line that a convex piece reaches.
class Within {
  public:
    void add(double u) noexcept {
        from_ = std::min(from_, u);
        to_ = std::max(to_, u);
    }
    /// Adds the intersection with a circle.
    void add_circle(double u, double off, double radius) noexcept {
        if (const double squared = radius * radius - off * off; squared >= 0) {
            const double half = std::sqrt(squared);
            add(u - half);
            add(u + half);
        }
    }
    /// Adds the intersection with the side from a to b, on a line at v; x is u and y is v.
    void add_side(const Point2& a, const Point2& b, double v) noexcept {
        if ((a.y <= v) != (b.y <= v))
            add(a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x));
    }
    [[nodiscard]] double from() const noexcept { return from_; }
    [[nodiscard]] double to() const noexcept { return to_; }

  private:
    double from_ = std::numeric_limits<double>::infinity();
    double to_ = -from_;
};

/// A piece of a line.
struct Piece {
    double from;
    double to;
};

/// Sums up pieces of lines: all of them in one area, and only large spots of them in another one. Pieces of
/// neighbouring lines that overlap belong to the same spot.
class BareSum {
  public:
    explicit BareSum(double largest_tip) : largest_tip_(largest_tip) {}

    void add(double length) noexcept { sum_ += length; }
    /// Adds a piece of a spot, after those of the lines before and those before it on its line.
    void add_to_spot(std::size_t line, Piece piece) {
        if (line != line_) {
            before_ = line == line_ + 1 ? std::exchange(here_, {}) : std::vector<InSpot>();
            here_.clear();
            next_ = 0;
            line_ = line;
        }
        const auto spot = static_cast<std::uint32_t>(parents_.size());
        parents_.push_back(spot);
        sizes_.push_back(piece.to - piece.from);
        while (next_ < before_.size() && before_[next_].piece.to < piece.from)
            ++next_;
        for (std::size_t i = next_; i < before_.size() && before_[i].piece.from <= piece.to; ++i)
            join(before_[i].spot, spot);
        here_.push_back({piece, spot});
    }
    [[nodiscard]] double sum() {
        double all = sum_;
        for (std::uint32_t spot = 0; spot < parents_.size(); ++spot)
            if (root(spot) == spot && sizes_[spot] > largest_tip_)
                all += sizes_[spot];
        return all;
    }

  private:
    struct InSpot {
        Piece piece;
        std::uint32_t spot;
    };

    std::uint32_t root(std::uint32_t spot) {
        while (parents_[spot] != spot)
            spot = parents_[spot] = parents_[parents_[spot]];
        return spot;
    }
    void join(std::uint32_t one, std::uint32_t other) {
        one = root(one);
        other = root(other);
        if (one == other)
            return;
        parents_[other] = one;
        sizes_[one] += sizes_[other];
    }

    double largest_tip_; ///< mm of lines
    double sum_ = 0;
    std::size_t line_ = 0;
    std::vector<InSpot> before_; ///< on the line before
    std::size_t next_ = 0;       ///< of these, the first one that further pieces may overlap
    std::vector<InSpot> here_;
    std::vector<std::uint32_t> parents_;
    std::vector<double> sizes_;
};

/// The lines across an area, and what reaches their pieces.
class Measured {
  public:
    Measured(const Layer& positions, const Reached& reached, const MeasuringLines& how, const Layer& wide,
             double tip_mm2, const LayerBudget& budget)
        : area_(std::max(0.0, measure(positions).area_mm2)),
          lines_(positions, how.angle, how.distance, 0, budget), distance_(how.distance),
          budget_(budget.without(lines_.bytes())), wide_(wide, how.angle, how.distance, 0, budget_),
          sum_(tip_mm2 / how.distance) {
        find_near(positions, reached);
    }

    [[nodiscard]] double area() {
        // Few lines at a time, so that the intervals that vectors reach take little memory.
        const std::uint64_t most = std::min(std::uint64_t{1} << 19, budget_.room(2 * sizeof(Piece)));
        for (std::size_t line = 0; line < lines_.size();) {
            const std::size_t first = line;
            for (std::uint64_t count = 0; line < lines_.size(); ++line) {
                count += counts_[line];
                if (line > first && count > most)
                    break;
            }
            measure_lines(first, line);
        }
        double all = 0;
        for (std::size_t i = 0; i < lines_.size(); ++i) {
            const std::span<const double> ends = lines_.ends(i);
            for (std::size_t k = 0; k < ends.size(); k += 2)
                all += ends[k + 1] - ends[k];
        }
        return all > 0 ? area_ * std::min(1.0, sum_.sum() / all) : 0;
    }

  private:
    /// A vector or corner in the frame of the lines, and the lines that it may reach.
    struct Near {
        std::array<Point2, 4> points;
        double reach; ///< of a vector, which has two points; 0 for a corner
        std::uint32_t first;
        std::uint32_t last; ///< the line beyond the last one
    };

    void find_near(const Layer& positions, const Reached& reached) {
        const Box2 box = box_of(positions.points.span());
        rounding_ = box.largest_coordinate() * 0x1p-40;
        Occupied occupied(positions); // most vectors are far from all rings
        for (std::size_t i = 0; i < positions.rings; ++i)
            occupied.add(box_of(positions.contour(i)));
        std::vector<std::int64_t> begins(lines_.size() + 1, 0); // first differences of the counts
        const auto add = [&](const Box2& around, std::array<Point2, 4> points, std::size_t count,
                             double reach) {
            budget_.check();
            if (!box.meets(around) || !occupied.any_within(around))
                return;
            double low = std::numeric_limits<double>::infinity();
            double high = -low;
            for (std::size_t i = 0; i < count; ++i) {
                points[i] = {lines_.frame().along(points[i]), lines_.frame().across(points[i])};
                low = std::min(low, points[i].y);
                high = std::max(high, points[i].y);
            }
            const auto line_number = [&](double v) {
                return static_cast<std::uint32_t>(
                    std::clamp(std::floor(v / distance_) - static_cast<double>(lines_.first()), 0.0,
                               static_cast<double>(lines_.size())));
            };
            const Near one{points, reach, line_number(low - reach),
                           line_number(high + reach + 2 * distance_)};
            if (one.first >= one.last)
                return;
            if (near_.size() == near_.capacity())
                budget_.need(2 * near_.size(), sizeof(Near), "vectors beside narrow material");
            near_.push_back(one);
            ++begins[one.first];
            --begins[one.last];
        };
        for (const Stroke& stroke : reached.strokes)
            add(Box2::of(stroke.from, stroke.to).grown(stroke.reach), {stroke.from, stroke.to, {}, {}}, 2,
                stroke.reach);
        for (const std::array<Point2, 4>& corner : reached.corners)
            add(box_of(corner), corner, corner.size(), 0);
        counts_.resize(lines_.size());
        std::partial_sum(begins.begin(), begins.end() - 1, counts_.begin());
    }

    /// Returns the piece of line i that a vector or corner reaches.
    [[nodiscard]] Piece piece_of(const Near& one, std::size_t i) const noexcept {
        const double v = lines_.v(i);
        const auto& p = one.points;
        Within within;
        if (one.reach == 0) {
            for (std::size_t k = 0; k < p.size(); ++k)
                within.add_side(p[k], p[(k + 1) % p.size()], v);
            return {within.from(), within.to()};
        }
        const Point2 to{p[1].x - p[0].x, p[1].y - p[0].y};
        const double length = std::sqrt(dot_product(to, to));
        const double share = length > 0 ? one.reach / length : 0;
        const Point2 left{-to.y * share, to.x * share};
        within.add_circle(p[0].x, v - p[0].y, one.reach);
        within.add_circle(p[1].x, v - p[1].y, one.reach);
        within.add_side({p[0].x + left.x, p[0].y + left.y}, {p[1].x + left.x, p[1].y + left.y}, v);
        within.add_side({p[0].x - left.x, p[0].y - left.y}, {p[1].x - left.x, p[1].y - left.y}, v);
        return {within.from(), within.to()};
    }

    void measure_lines(std::size_t first, std::size_t last) {
        std::vector<std::uint64_t> ends(last - first + 1, 0); // of the pieces on each line
        for (std::size_t i = first; i < last; ++i)
            ends[i - first + 1] = ends[i - first] + static_cast<std::uint64_t>(counts_[i]);
        budget_.need(ends.back(), sizeof(Piece), "pieces of lines that vectors reach");
        std::vector<Piece> pieces(ends.back());
        std::vector<std::uint64_t> next(ends.begin(), ends.end() - 1);
        for (const Near& one : near_) {
            budget_.check();
            for (std::size_t i = std::max<std::size_t>(one.first, first);
                 i < std::min<std::size_t>(one.last, last); ++i) {
                if (lines_.ends(i).empty())
                    continue;
                const Piece piece = piece_of(one, i);
                if (piece.from < piece.to)
                    pieces[next[i - first]++] = piece;
            }
        }
        for (std::size_t i = first; i < last; ++i) {
            const std::span<Piece> here =
                std::span(pieces).subspan(ends[i - first], next[i - first] - ends[i - first]);
            std::sort(here.begin(), here.end(), [](const Piece& a, const Piece& b) {
                return std::tie(a.from, a.to) < std::tie(b.from, b.to);
            });
            measure_line(i, here);
        }
    }

    /// Finds the pieces of a line that nothing reaches.
    void measure_line(std::size_t i, std::span<const Piece> reached) {
        const std::span<const double> own = lines_.ends(i);
        auto next = reached.begin();
        for (std::size_t k = 0; k < own.size(); k += 2) {
            double at = own[k];
            while (next != reached.end() && next->to <= at)
                ++next;
            // Intervals may reach across several pieces, so `next` stays.
            for (auto one = next; one != reached.end() && one->from < own[k + 1]; ++one) {
                if (one->from > at)
                    add_bare(i, {at, one->from});
                at = std::max(at, one->to);
            }
            if (at < own[k + 1])
                add_bare(i, {at, own[k + 1]});
        }
    }

    void add_bare(std::size_t i, Piece bare) {
        if (!(bare.to - bare.from > rounding_)) // where the edges of a strip and of the material coincide
            return;
        const std::int64_t number = static_cast<std::int64_t>(i) + lines_.first() - wide_.first();
        const std::span<const double> wide = number >= 0 && number < static_cast<std::int64_t>(wide_.size())
                                                 ? wide_.ends(static_cast<std::size_t>(number))
                                                 : std::span<const double>();
        double at = bare.from;
        for (std::size_t k = 0; k < wide.size(); k += 2) {
            const double from = std::max(at, wide[k]);
            const double to = std::min(bare.to, wide[k + 1]);
            if (from >= to)
                continue;
            sum_.add(from - at);
            sum_.add_to_spot(i, {from, to});
            at = to;
        }
        sum_.add(bare.to - at);
    }

    double area_;
    HatchLines lines_;
    double distance_;
    LayerBudget budget_;
    HatchLines wide_;
    BareSum sum_;
    double rounding_ = 0;
    std::vector<Near> near_;
    std::vector<std::int64_t> counts_; ///< of what may reach each line
};

constexpr double rounded_slivers = 1 + 1e-5; // grown so much further, nothing of a wall remains but rounding

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
        Side before(line.back(), line.front());
        for (std::size_t p = 0; line.size() > 2 && p < line.size(); ++p) {
            const Side after(line[p], line[p + 1 == line.size() ? 0 : p + 1]);
            add_corner(line[p], before, after, reach, *this);
            before = after;
        }
    }
    for (std::size_t i = 0; i + 1 < lines.size(); i += 2)
        strokes.push_back({rounded(lines[i], rounding), rounded(lines[i + 1], rounding), reach});
}

Reached Reached::near(const Layer& positions) const {
    Occupied occupied(positions);
    for (std::size_t i = 0; i < positions.rings; ++i)
        occupied.add(box_of(positions.contour(i)));
    Reached near;
    std::copy_if(strokes.begin(), strokes.end(), std::back_inserter(near.strokes), [&](const Stroke& stroke) {
        return occupied.any_within(Box2::of(stroke.from, stroke.to).grown(stroke.reach));
    });
    std::copy_if(corners.begin(), corners.end(), std::back_inserter(near.corners),
                 [&](const std::array<Point2, 4>& corner) { return occupied.any_within(box_of(corner)); });
    return near;
}

FillDepths::FillDepths(const ScanStrategy& strategy) {
    const ContourRule& contours = strategy.contours;
    const double reach = contour_reach(contours);
    least_reach = contours.count > 0 && reach > 0 ? reach : std::numeric_limits<double>::infinity();
    dense = contours.count > 0 && (contours.count == 1 || contours.distance <= 2 * reach);
    double shortest = 0;
    double most = 0;
    const auto add = [&](const HatchRule& rule) {
        const double hatch = hatch_reach(contours, rule);
        filled = std::max(filled, hatch_depth(contours, rule));
        half_width = std::max(half_width, surely_hatched(rule) / 2);
        least_reach = std::min(least_reach, hatch);
        shortest = std::max(shortest, rule.shortest);
        most = std::max(most, hatch);
        dense = dense && rule.border <= reach && hatch >= rule.distance;
    };
    add(strategy.hatch);
    for (const SkinRule* const skin : {&strategy.upskin, &strategy.downskin})
        if (skin->layers > 0)
            add(skin->hatch);
    // The largest tip of a corner of 30 degrees in which all lines are too short has 0.93 times the square of
    // the shortest line.
    tip_mm2 = shortest * shortest + most * most / 2;
}

Layer grown_to_corners(const Layer& inset, double by, const LayerLimits& limits) {
    return offset(inset, by * rounded_slivers, {.corners = {.mitre_limit = reached_mitre}, .limits = limits});
}

Layer wide_points(const Layer& material, double depth, const FillDepths& depths, const LayerLimits& limits) {
    const double in = std::max(0.0, depths.filled - depth) + depths.half_width;
    return grown_to_corners(offset(material, -in, {.limits = limits}), depths.half_width, limits);
}

BodiesByWidth bodies_by_width(const Layer& material, const Layer& inset, double by) {
    InsetRings rings(inset, by);
    std::vector<bool> moved(material.rings, false);
    for (std::size_t i = 0; i < material.rings; ++i)
        moved[i] = rings.take(material.contour(i));
    const bool all = std::find(moved.begin(), moved.end(), false) == moved.end();
    if (all && rings.all_taken())
        return {.narrow = {}, .wide = material};
    std::vector<std::uint32_t> narrow;
    std::vector<std::uint32_t> wide;
    for (const Polygon& body : polygons(nesting(material))) {
        const std::vector<std::uint32_t> own = rings_of(body);
        const bool is_narrow =
            all || std::any_of(own.begin(), own.end(), [&](std::uint32_t ring) { return !moved[ring]; });
        std::vector<std::uint32_t>& some = is_narrow ? narrow : wide;
        some.insert(some.end(), own.begin(), own.end());
    }
    return {.narrow = rings_of(material, std::move(narrow)), .wide = rings_of(material, std::move(wide))};
}

Layer inset_of_narrow(const BodiesByWidth& bodies, const Layer& inset, double by, const LayerLimits& limits) {
    if (bodies.wide.rings == 0)
        return inset;
    InsetRings rings(inset, by);
    for (std::size_t i = 0; i < bodies.wide.rings; ++i)
        if (!rings.take(bodies.wide.contour(i)))
            return offset(bodies.narrow, -by, {.limits = limits});
    return rings.others();
}

Layer narrow_points(const Layer& material, const Layer& inset, double by, const LayerLimits& limits) {
    if (!(by > 0) || material.rings == 0)
        return {};
    if (inset.rings == 0)
        return material;
    return combine(material, grown_to_corners(inset, by, limits), BooleanOperation::subtract, limits);
}

// Strips beside sides and lines are at least 7.5 degrees from the best of these directions, unless there are
// sides in all directions.
MeasuringLines::MeasuringLines(const Layer& material, const Reached& reached, double least_reach) {
    constexpr std::size_t directions = 12;
    constexpr double near = 0.13; // the sine of 7.5 degrees
    std::array<CosSin, directions> angles;
    for (std::size_t i = 0; i < directions; ++i)
        angles[i] = cos_sin_degrees(27.18 + 15.0 * static_cast<double>(i));
    std::array<double, directions> lengths{};
    const auto add = [&](const Point2& a, const Point2& b) {
        const Side side(a, b);
        for (std::size_t i = 0; i < directions; ++i)
            if (std::abs(side.way.x * angles[i].sin - side.way.y * angles[i].cos) < near)
                lengths[i] += side.length;
    };
    for (std::size_t i = 0; i < material.rings; ++i) {
        const std::span<const Point2> ring = material.contour(i);
        for (std::size_t p = 0; p < ring.size(); ++p)
            add(ring[p == 0 ? ring.size() - 1 : p - 1], ring[p]);
    }
    for (const Stroke& stroke : reached.strokes)
        add(stroke.from, stroke.to);
    angle =
        angles[static_cast<std::size_t>(std::min_element(lengths.begin(), lengths.end()) - lengths.begin())];
    constexpr double most_lines = 1 << 16;
    const Box2 box = material.points.empty() ? Box2{} : box_of(material.points.span());
    distance = std::max({std::isfinite(least_reach) ? least_reach / 4 : 0.0,
                         (box.width() + box.height()) / most_lines, box.largest_coordinate() * 0x1p-40});
}

double unreached_area(const Layer& positions, const Reached& reached, const MeasuringLines& lines,
                      const Layer& wide, double tip_mm2, const LayerBudget& budget) {
    return positions.rings == 0 ? 0 : Measured(positions, reached, lines, wide, tip_mm2, budget).area();
}

Layer bare_points(const Layer& positions, const Reached& reached, const MeasuringLines& lines,
                  double least_reach, const LayerBudget& budget) {
    const double accepted = negligible(least_reach);
    if (!(unreached_area(positions, reached, lines, {}, 0, budget) > accepted))
        return {};
    const Reached near = reached.near(positions);
    std::vector<std::uint32_t> bare;
    for (const Polygon& body : polygons(nesting(positions))) {
        const std::vector<std::uint32_t> own = rings_of(body);
        if (unreached_area(rings_of(positions, own), near, lines, {}, 0, budget) > accepted)
            bare.insert(bare.end(), own.begin(), own.end());
    }
    return normal_form(rings_of(positions, std::move(bare)));
}

} // namespace lamella
