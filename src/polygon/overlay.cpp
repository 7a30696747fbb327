#include "polygon/overlay.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/polygon/crossings.hpp"

#include "polygon/arrangement.hpp"
#include "polygon/boundary.hpp"
#include "polygon/clipping_grid.hpp"
#include "polygon/close_rings.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace lamella {

namespace {

/// Returns the fate of a ring, given whether there is material just outside and just inside of it.
Fate fate(bool outside, bool inside, bool counter_clockwise) noexcept {
    if (outside == inside)
        return Fate::dropped;
    return inside == counter_clockwise ? Fate::kept : Fate::reversed;
}

std::int64_t left_of(Fate fate) noexcept {
    return fate == Fate::kept ? 1 : fate == Fate::reversed ? -1 : 0;
}

class Filler {
  public:
    Filler(const Layer& layer, std::span<const Windings> turns, const Material& material, Walls walls,
           const Contacts& contacts, const NestingWithWindings& nest, const LayerBudget& budget,
           const CrossingLimit& most, Closeness closeness)
        : layer_(layer), turns_(turns), material_(material), walls_(walls), nest_(nest), budget_(budget),
          most_(most), closeness_(closeness), groups_(contacts.groups), fates_(layer.rings) {
        assert(contacts.group.size() == layer.rings && nest.nesting.order.size() == layer.rings);
        for (const std::uint32_t ring : nest.nesting.order) {
            const std::uint32_t group = contacts.group[ring];
            if (flat(ring))
                fates_[ring] = Fate::dropped;
            else if (group != Contacts::none)
                groups_[group].push_back(ring);
            else
                fates_[ring] = fate_by_left_end(ring);
        }
    }

    Overlaid run() && {
        for (const std::vector<std::uint32_t>& group : groups_)
            fill_group(group);
        // Rounding can move the boundary of a united group across rings of other groups, if they are closer
        // to it than a unit of the grid.
        const bool others = result_.groups_united > 1 || count(Fate::kept) + count(Fate::reversed) > 0;
        if (!united_.empty() && others && has_crossings(put_together()))
            unite_all();
        result_.rings_dropped = count(Fate::dropped);
        result_.rings_reversed = count(Fate::reversed);
        if (!result_.changed())
            result_.layer = layer_;
        else
            result_.layer = put_together();
        return {std::move(result_), std::move(fates_)};
    }

  private:
    [[nodiscard]] std::uint64_t count(Fate wanted) const {
        return static_cast<std::uint64_t>(std::count(fates_.begin(), fates_.end(), wanted));
    }
    [[nodiscard]] bool flat(std::uint32_t ring) const noexcept {
        return nest_.nesting.kind[ring] == RingKind::flat;
    }
    [[nodiscard]] Fate fate_by_left_end(std::uint32_t ring) const noexcept {
        return fate(material_(nest_.outside[ring]), material_(nest_.inside[ring]),
                    nest_.inside[ring].sum() > nest_.outside[ring].sum());
    }

    /// Processes a group of rings in contact, ordered from left to right; none of them may be flat.
    void fill_group(const std::vector<std::uint32_t>& group) {
        if (group.empty())
            return;
        // No ring of the group lies below the left end of its first ring.
        const Windings around = nest_.below[group.front()];
        Windings most;
        for (const std::uint32_t ring : group) {
            fates_[ring] = fate_by_left_end(ring);
            most += turns_[ring];
        }
        if (material_.alike(around, most)) {
            for (const std::uint32_t ring : group)
                fates_[ring] = Fate::dropped;
            return;
        }
        if (!grid_)
            grid_.emplace(layer_.points.span().first(layer_.offsets[layer_.rings]));
        const bool of_both = most.first > 0 && most.second > 0;
        const Bundles bundles =
            of_both && closeness_ == Closeness::rounding ? Bundles::always : Bundles::when_many;
        const Arrangement arrangement = arranged(wound(group), around, *grid_, budget_, most_, bundles);
        if (arrangement.crossed || !stay(group, arrangement, most))
            unite(group, arrangement);
        else if (!material_(around) && cancel_exactly(group))
            for (const std::uint32_t ring : group)
                fates_[ring] = Fate::dropped;
    }

    /// Returns whether each side of the rings that stay has a partner that runs the opposite way, as where a
    /// plane touches a knife edge. Thin rings that only rounding to the grid makes cancel do not.
    [[nodiscard]] bool cancel_exactly(std::span<const std::uint32_t> group) const {
        std::vector<std::pair<Point2, Point2>> forwards;
        std::vector<std::pair<Point2, Point2>> backwards;
        for (const std::uint32_t ring : group) {
            if (fates_[ring] == Fate::dropped)
                continue;
            const std::span<const Point2> corners = layer_.contour(ring);
            for (std::size_t i = 0; i < corners.size(); ++i) {
                const Point2& a = corners[i];
                const Point2& b = corners[i + 1 < corners.size() ? i + 1 : 0];
                if ((a < b) == (fates_[ring] == Fate::kept))
                    forwards.push_back(std::minmax(a, b));
                else
                    backwards.push_back(std::minmax(a, b));
            }
        }
        std::sort(forwards.begin(), forwards.end());
        std::sort(backwards.begin(), backwards.end());
        return forwards == backwards;
    }

    [[nodiscard]] std::vector<RingWithWinding> wound(std::span<const std::uint32_t> group) const {
        std::vector<RingWithWinding> rings;
        for (const std::uint32_t ring : group)
            rings.push_back({layer_.contour(ring), turns_[ring], left_of(fates_[ring])});
        return rings;
    }

    void unite(std::span<const std::uint32_t> group, const Arrangement& arrangement) {
        for (const std::uint32_t ring : group)
            fates_[ring] = Fate::united;
        ++result_.groups_united;
        result_.rings_united += group.size();
        for (Ring& ring : boundary(arrangement, material_, *grid_))
            if (!is_sliver(ring))
                united_.push_back(std::move(ring));
    }

    /// Returns whether a ring is so thin that rounding to the grid may have inverted or flattened it.
    [[nodiscard]] bool is_sliver(const Ring& ring) const {
        return std::abs(ring_area(ring)) <= grid_->unit() * contour_length(ring, true);
    }

    /// Unites all rings as one group in contact.
    void unite_all() {
        std::vector<std::uint32_t> all = nest_.nesting.order;
        std::erase_if(all, [this](std::uint32_t ring) { return flat(ring); });
        united_.clear();
        result_ = {};
        unite(all, arranged(wound(all), {}, *grid_, budget_, most_));
    }

    /// Returns whether all rings of the group can stay whole, because they do not cross, and sets their
    /// fates.
    bool stay(const std::vector<std::uint32_t>& group, const Arrangement& arrangement, const Windings& most) {
        if (walls_ == Walls::dissolved || (most.first > 0 && most.second > 0))
            return !arrangement.walls && arrangement.bounded_by_rest(material_);
        if (!arrangement.bounded_by_all(material_))
            return arrangement.bounded_by_rest(material_);
        // An overlap of the size of rounding errors may be at the left end of a ring.
        for (const std::uint32_t ring : group)
            fates_[ring] = Fate::kept;
        return true;
    }

    Layer put_together() const {
        LayerBuilder builder;
        const auto add = [&](const auto& begin, const auto& end, bool closed) {
            for (auto p = begin; p != end; ++p)
                builder.add_point(*p);
            builder.end_contour(closed);
        };
        for (std::size_t i = 0; i < layer_.contours(); ++i) {
            const std::span<const Point2> points = layer_.contour(i);
            if (!layer_.closed(i) || fates_[i] == Fate::kept)
                add(points.begin(), points.end(), layer_.closed(i));
            else if (fates_[i] == Fate::reversed)
                add(points.rbegin(), points.rend(), true);
        }
        for (const Ring& ring : united_)
            add(ring.begin(), ring.end(), true);
        return builder.finish(layer_.index, layer_.z, layer_.bottom, layer_.top);
    }

    const Layer& layer_;
    std::span<const Windings> turns_;
    const Material& material_;
    Walls walls_;
    const NestingWithWindings& nest_;
    const LayerBudget& budget_;
    const CrossingLimit& most_;
    Closeness closeness_;
    std::vector<std::vector<std::uint32_t>> groups_;
    std::vector<Fate> fates_;
    std::optional<ClippingGrid> grid_;
    std::vector<Ring> united_;
    Filled result_;
};

} // namespace

Overlay::Overlay(const Layer& layer, std::vector<Windings> turns, const LayerLimits& limits,
                 const CrossingLimit& most, Closeness closeness)
    : layer_(layer), budget_(limits, layer.index, layer.z), most_(most), closeness_(closeness),
      turns_(std::move(turns)), chains_(layer), grid_(ChainGrid::of(chains_)),
      contacts_(find_contacts(layer, chains_, grid_, budget_)),
      nest_(nesting(layer, chains_, grid_, contacts_, turns_, budget_, most_)) {
    if (closeness == Closeness::rounding)
        contacts_ = with_close_rings(layer, turns_, contacts_);
}

bool Overlay::clean() const noexcept {
    if (contacts_.groups > 0)
        return false;
    const Nesting& nest = nest_.nesting;
    for (std::size_t i = 0; i < nest.rings(); ++i)
        if (nest.kind[i] != RingKind::outer && !(nest.kind[i] == RingKind::hole && nest.winding[i] == 1))
            return false;
    return true;
}

Box2 Overlay::box() const noexcept {
    Box2 box = chains_.box(0);
    for (std::size_t i = 1; i < layer_.rings; ++i)
        box.add(chains_.box(i));
    return box;
}

Overlaid Overlay::filled(const Material& material, Walls walls) const {
    return Filler(layer_, turns_, material, walls, contacts_, nest_, budget_, most_, closeness_).run();
}

std::vector<CellArea> Overlay::areas() const {
    return cell_areas(layer_, turns_, contacts_, nest_, budget_, most_);
}

Layer united(const Layer& layer, const LayerLimits& limits) {
    return united(layer, Overlay(layer, limits));
}

Layer united(const Layer& layer, const Overlay& overlay) {
    return overlay.clean() ? layer
                           : overlay.filled(Material(FillRule::positive), Walls::dissolved).filled.layer;
}

} // namespace lamella
