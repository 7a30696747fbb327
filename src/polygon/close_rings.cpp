#include "polygon/close_rings.hpp"

#include "polygon/clipping_grid.hpp"
#include "polygon/close_sides.hpp"
#include "polygon/orientation.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <utility>

namespace lamella {

namespace {

constexpr double reach = 4; // units: rounding moves two collinear sides apart by up to 2 * sqrt(0.5) units

/// A side of a ring that may come close to other sides, in units of the grid.
struct CloseSide {
    Segment line;
    std::uint32_t ring;
};

/// Returns these sides by their left ends.
std::vector<CloseSide> close_sides_of(const Layer& layer) {
    Layer positions{.index = layer.index};
    const ClippingGrid grid(layer.points.span().first(layer.offsets[layer.rings]));
    std::vector<Point2> points;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        for (const Point2& p : layer.contour(i))
            points.push_back(grid.position(p));
        positions.offsets.push_back(points.size());
    }
    positions.rings = layer.rings;
    positions.points = PointArray(std::move(points));
    const std::vector<bool> close = close_sides(positions, reach);
    std::vector<CloseSide> sides;
    for (std::uint32_t ring = 0; ring < layer.rings; ++ring) {
        const std::span<const Point2> corners = positions.contour(ring);
        for (std::size_t i = 0; i < corners.size(); ++i)
            if (close[positions.offsets[ring] + i])
                sides.push_back(
                    {segment_between(corners[i], corners[i + 1 < corners.size() ? i + 1 : 0]), ring});
    }
    std::sort(sides.begin(), sides.end(), [](const CloseSide& a, const CloseSide& b) {
        return a.line.lo != b.line.lo ? a.line.lo < b.line.lo : a.ring < b.ring;
    });
    return sides;
}

/// Groups of rings that are joined one pair after the other.
class JoinedGroups {
  public:
    explicit JoinedGroups(const Contacts& contacts) : next_(contacts.group.size()) {
        std::iota(next_.begin(), next_.end(), 0U);
        std::vector<std::uint32_t> first(contacts.groups, Contacts::none);
        for (std::uint32_t i = 0; i < next_.size(); ++i)
            if (const std::uint32_t group = contacts.group[i]; group != Contacts::none) {
                first[group] = std::min(first[group], i);
                join(first[group], i);
            }
        grouped_.assign(next_.size(), false);
        for (std::uint32_t i = 0; i < next_.size(); ++i)
            grouped_[i] = contacts.group[i] != Contacts::none;
    }
    void join_close(std::uint32_t a, std::uint32_t b) {
        grouped_[a] = grouped_[b] = true;
        join(a, b);
    }
    [[nodiscard]] Contacts contacts() {
        Contacts result{std::vector<std::uint32_t>(next_.size(), Contacts::none), 0};
        for (std::uint32_t i = 0; i < next_.size(); ++i)
            if (grouped_[i]) {
                const std::uint32_t first =
                    first_of(i); // the smallest of its group, so it is numbered already
                result.group[i] = first == i ? result.groups++ : result.group[first];
            }
        return result;
    }

  private:
    [[nodiscard]] std::uint32_t first_of(std::uint32_t i) {
        while (next_[i] != i)
            i = next_[i] = next_[next_[i]];
        return i;
    }
    void join(std::uint32_t a, std::uint32_t b) {
        const auto [low, high] = std::minmax({first_of(a), first_of(b)}); // values, not references
        next_[high] = low;
    }

    std::vector<std::uint32_t> next_; ///< towards the first ring of the group
    std::vector<bool> grouped_;
};

} // namespace

Contacts with_close_rings(const Layer& layer, const std::vector<Windings>& turns, const Contacts& contacts) {
    if (layer.rings < 2)
        return contacts;
    const std::vector<CloseSide> sides = close_sides_of(layer);
    JoinedGroups groups(contacts);
    const auto of_both = [&](std::uint32_t a, std::uint32_t b) {
        return (turns[a].first != 0 || turns[b].first != 0) && (turns[a].second != 0 || turns[b].second != 0);
    };
    std::uint64_t tests_left = 64 * (layer.points.size() + sides.size());
    for (std::size_t i = 0; i < sides.size(); ++i)
        for (std::size_t k = i + 1; k < sides.size() && sides[k].line.lo.x <= sides[i].line.hi.x + reach;
             ++k) {
            if (tests_left-- == 0) {
                // One group of all rings is right, too.
                for (std::uint32_t ring = 1; ring < layer.rings; ++ring)
                    groups.join_close(0, ring);
                return groups.contacts();
            }
            if (sides[i].ring != sides[k].ring && of_both(sides[i].ring, sides[k].ring) &&
                may_come_within(sides[i].line, sides[k].line, reach))
                groups.join_close(sides[i].ring, sides[k].ring);
        }
    return groups.contacts();
}

} // namespace lamella
