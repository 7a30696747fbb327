#include "scan/narrow_bodies.hpp"

#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/nesting.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/box2.hpp"
#include "scan/chosen_rings.hpp"
#include "scan/hatch.hpp"
#include "scan/reached.hpp"
#include "scan/ring_side.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

namespace lamella {

namespace {

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
        return chosen_rings(inset_, [this](std::size_t i) { return !taken_[i]; });
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
            const RingSide side(ring[i], ring[i + 1 == ring.size() ? 0 : i + 1]);
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

constexpr double rounded_slivers = 1 + 1e-5; // a factor of growth that leaves nothing of a wall but rounding

} // namespace

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

Layer wide_area(const Layer& material, double depth, const FillDepths& depths, const LayerLimits& limits) {
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
    std::vector<bool> narrow(material.rings, false);
    std::vector<bool> wide(material.rings, false);
    for (const Polygon& body : polygons(nesting(material))) {
        const auto is_moved = [&](std::uint32_t ring) {
            return static_cast<bool>(moved[ring]);
        };
        const bool is_wide =
            !all && is_moved(body.outer) && std::all_of(body.holes.begin(), body.holes.end(), is_moved);
        choose(body, is_wide ? wide : narrow);
    }
    const auto chosen = [&](const std::vector<bool>& rings) {
        return chosen_rings(material, [&](std::size_t i) { return rings[i]; });
    };
    return {.narrow = chosen(narrow), .wide = chosen(wide)};
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

Layer narrow_area(const Layer& material, const Layer& inset, double by, const LayerLimits& limits) {
    if (!(by > 0) || material.rings == 0)
        return {};
    if (inset.rings == 0)
        return material;
    return combine(material, grown_to_corners(inset, by, limits), BooleanOperation::subtract, limits);
}

} // namespace lamella
