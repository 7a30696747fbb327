#include "polygon/cell_areas.hpp"

#include "lamella/contour/measure.hpp"

#include "contour/distance.hpp"
#include "polygon/arrangement.hpp"
#include "polygon/clipping_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

namespace lamella {

namespace {

__extension__ using ExactArea = __int128;

/// Adds up the areas on both sides of boundaries.
class CellAreaSums {
  public:
    /// Adds a ring without contacts: its inside, without the rings in it, and its outside as a hole.
    void add_ring(const Windings& outside, const Windings& inside, double mm2) {
        Sum& within = sums_[key(inside)];
        within.mm2 += mm2;
        within.certain = true; // there is an area next to each side of such a ring
        Sum& around = sums_[key(outside)];
        around.mm2 -= mm2;
        around.certain = true;
    }

    /// Adds a segment of a side of an arrangement, from left to right.
    void add_segment(const Side& side, const Point2& from, const Point2& to) {
        // Positions are integers of at most 2^37, so sums of these products are exact.
        const auto whole = [](double number) {
            return static_cast<std::int64_t>(number);
        };
        const ExactArea twice =
            ExactArea{whole(to.x) - whole(from.x)} * (whole(from.y) + whole(to.y)); // below the segment
        const double length = quick_distance(from, to);
        Sum& below = sums_[key(side.below.windings)];
        below.twice += twice;
        below.length += length;
        Sum& above = sums_[key(side.above().windings)];
        above.twice -= twice;
        above.length += length;
    }

    [[nodiscard]] std::vector<CellArea> areas(double unit) const {
        std::vector<CellArea> areas;
        for (const auto& [windings, sum] : sums_) {
            const double of_sides = static_cast<double>(sum.twice) / 2;
            if ((windings.first != 0 || windings.second != 0) && (sum.certain || of_sides > sum.length))
                areas.push_back(
                    {{windings.first, windings.second}, std::max(0.0, sum.mm2 + of_sides * unit * unit)});
        }
        return areas;
    }

  private:
    struct Sum {
        double mm2 = 0;      ///< of rings without contacts
        ExactArea twice = 0; ///< twice the area beside sides, in units of the grid
        double length = 0;   ///< of these sides, in units
        bool certain = false;
    };

    [[nodiscard]] static std::pair<std::int64_t, std::int64_t> key(const Windings& windings) noexcept {
        return {windings.first, windings.second};
    }

    std::map<std::pair<std::int64_t, std::int64_t>, Sum> sums_;
};

void add_sides(const Arrangement& arrangement, CellAreaSums& sums) {
    for (const Side& side : arrangement.sides) {
        Point2 from = side.line.lo;
        for (const Corner& corner : arrangement.corners_of(side)) {
            sums.add_segment(side, from, corner.position);
            from = corner.position;
        }
        sums.add_segment(side, from, side.line.hi);
    }
}

} // namespace

std::vector<CellArea> cell_areas(const Layer& layer, std::span<const Windings> turns,
                                 const Contacts& contacts, const NestingWithWindings& nest,
                                 const LayerBudget& budget, const CrossingLimit& most) {
    CellAreaSums sums;
    std::vector<std::vector<std::uint32_t>> groups(contacts.groups);
    for (const std::uint32_t ring : nest.nesting.order) {
        if (nest.nesting.kind[ring] == RingKind::flat)
            continue;
        if (contacts.group[ring] != Contacts::none)
            groups[contacts.group[ring]].push_back(ring);
        else
            sums.add_ring(nest.outside[ring], nest.inside[ring], std::abs(ring_area(layer.contour(ring))));
    }
    std::optional<ClippingGrid> grid;
    for (const std::vector<std::uint32_t>& group : groups) {
        if (group.empty())
            continue;
        if (!grid)
            grid.emplace(layer.points.span().first(layer.offsets[layer.rings]));
        std::vector<RingWithWinding> rings;
        for (const std::uint32_t ring : group)
            rings.push_back({layer.contour(ring), turns[ring]});
        // No ring of the group lies below the left end of its first ring.
        add_sides(arranged(rings, nest.below[group.front()], *grid, budget, most), sums);
    }
    return sums.areas(grid ? grid->unit() : 0);
}

} // namespace lamella
