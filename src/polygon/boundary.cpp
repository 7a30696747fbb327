#include "polygon/boundary.hpp"

#include "polygon/open_runs.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <numeric>
#include <tuple>
#include <utility>

namespace lamella {

namespace {

/// A side with material on its left.
struct Directed {
    Point2 from;
    Point2 to;
    Point2 second; ///< position that follows `from`
    Point2 last;   ///< position before `to`
    const Side* side;
};

Directed directed(const Arrangement& arrangement, const Side& side, bool rightwards) {
    const std::span<const Corner> corners = arrangement.corners_of(side);
    const auto& [lo, hi] = side.line;
    const Point2& next_to_lo = corners.empty() ? hi : corners.front().position;
    const Point2& next_to_hi = corners.empty() ? lo : corners.back().position;
    return rightwards ? Directed{lo, hi, next_to_lo, next_to_hi, &side}
                      : Directed{hi, lo, next_to_hi, next_to_lo, &side};
}

/// Returns whether the direction from v to a comes before that to b, clockwise from the direction to u.
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

/// The sides that are not yet in a ring, clockwise around each point where sides begin. Even if thousands of
/// sides begin at one point, the next side is found without a search through all of them.
class SidesAhead {
  public:
    /// `sides` are sorted by their beginnings and must outlive this object.
    explicit SidesAhead(std::span<const Directed> sides)
        : sides_(sides), clockwise_(sides.size()), position_(sides.size()), left_(sides.size() + 1) {
        std::iota(clockwise_.begin(), clockwise_.end(), std::size_t{0});
        std::iota(left_.begin(), left_.end(), std::size_t{0});
        for (std::size_t begin = 0, end = 0; begin < sides.size(); begin = end) {
            end = end_of(begin);
            std::sort(position(begin), position(end), [&](std::size_t a, std::size_t b) {
                return clockwise_before(sides[begin].from, sides[begin].second, sides[a].second,
                                        sides[b].second);
            });
        }
        for (std::size_t k = 0; k < clockwise_.size(); ++k)
            position_[clockwise_[k]] = k;
    }

    void take(std::size_t side) noexcept { left_[position_[side]] = position_[side] + 1; }

    /// Returns the first side that begins where `side` ends, clockwise from the direction back along `side`.
    [[nodiscard]] std::size_t after(const Directed& side) {
        const Point2& v = side.to;
        const auto begin =
            static_cast<std::size_t>(std::partition_point(sides_.begin(), sides_.end(),
                                                          [&](const Directed& s) { return s.from < v; }) -
                                     sides_.begin());
        const std::size_t end = end_of(begin);
        assert(begin < end); // equal numbers of sides begin and end at a point
        const Point2& first = sides_[begin].second;
        const auto next = std::partition_point(position(begin), position(end), [&](std::size_t i) {
            return !clockwise_before(v, first, side.last, sides_[i].second);
        });
        std::size_t found = next_left(static_cast<std::size_t>(next - clockwise_.begin()));
        if (found >= end)
            found = next_left(begin);
        assert(found < end);
        return clockwise_[found];
    }

  private:
    [[nodiscard]] std::vector<std::size_t>::iterator position(std::size_t i) {
        return clockwise_.begin() + static_cast<std::ptrdiff_t>(i);
    }
    /// Returns the end of the sides that begin at the same point.
    [[nodiscard]] std::size_t end_of(std::size_t side) const noexcept {
        std::size_t end = side;
        std::size_t step = 1;
        const auto same = [&](std::size_t i) {
            return i < sides_.size() && sides_[i].from == sides_[side].from;
        };
        while (same(end + step)) {
            end += step;
            step *= 2;
        }
        for (; step > 0; step /= 2)
            if (same(end + step))
                end += step;
        return end + 1;
    }
    [[nodiscard]] std::size_t next_left(std::size_t k) noexcept {
        while (left_[k] != k)
            k = left_[k] = left_[left_[k]];
        return k;
    }

    std::span<const Directed> sides_;
    std::vector<std::size_t> clockwise_; ///< for each point, beginning at the direction of its first side
    std::vector<std::size_t> position_;  ///< position of a side in that order
    std::vector<std::size_t> left_;      ///< links to the next position of an unused side
};

/// Joins sides to rings. Where several rings meet, each keeps its own wedge of material.
std::vector<std::vector<Directed>> joined(std::vector<Directed> sides) {
    std::sort(sides.begin(), sides.end(), [](const Directed& a, const Directed& b) {
        return std::tie(a.from, a.second) < std::tie(b.from, b.second);
    });
    SidesAhead ahead(sides);
    std::vector<bool> used(sides.size(), false);
    std::vector<std::vector<Directed>> rings;
    for (std::size_t start = 0; start < sides.size(); ++start) {
        if (used[start])
            continue;
        std::vector<Directed>& ring = rings.emplace_back();
        std::size_t at = start;
        do {
            used[at] = true;
            if (at != start)
                ahead.take(at);
            ring.push_back(sides[at]);
            at = ahead.after(sides[at]);
        } while (at != start);
        ahead.take(start);
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
        return std::tie(a.position, a.point) < std::tie(b.position, b.point);
    });
    // The smallest of the corners at a position, or the position itself if there are none.
    const auto end_at = [&](const Point2& position) {
        const auto corner = std::partition_point(ends.begin(), ends.end(),
                                                 [&](const Corner& c) { return c.position < position; });
        return corner != ends.end() && corner->position == position ? *corner
                                                                    : Corner{position, grid.point(position)};
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
    const bool crossed = std::move(runs).crossed(); // crossings can arise because corners get their original
                                                    // coordinates
    std::vector<Ring> result;
    for (const std::vector<Corner>& corners_of_ring : found) {
        Ring& ring = result.emplace_back();
        for (const Corner& corner : corners_of_ring)
            ring.push_back(crossed ? grid.point(corner.position) : corner.point);
    }
    return result;
}

std::vector<Ring> filled(std::span<const std::span<const Point2>> rings, FillRule rule,
                         const ClippingGrid& grid, const LayerBudget& budget) {
    std::vector<RingWithWinding> wound;
    wound.reserve(rings.size());
    for (const std::span<const Point2> ring : rings)
        wound.push_back({ring});
    return boundary(arranged(wound, {}, grid, budget), Material(rule), grid);
}

} // namespace lamella
