#include "lamella/polygon/fill.hpp"

#include "lamella/polygon/crossings.hpp"
#include "lamella/polygon/nesting.hpp"

#include "polygon/arrangement.hpp"
#include "polygon/contacts.hpp"
#include "polygon/known_nesting.hpp"
#include "polygon/monotone_chains.hpp"

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdlib>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

namespace {

enum class Fate : std::uint8_t { kept, reversed, dropped, united };

/// What fill() begins with.
struct Look {
    explicit Look(const Layer& layer)
        : chains(layer), grid(ChainGrid::of(chains)),
          contacts(find_contacts(layer, chains, grid ? &*grid : nullptr)),
          nest(nesting(layer, chains, grid ? &*grid : nullptr, contacts)) {}

    /// Whether no rings are in contact and all of them bound material, with none around it.
    [[nodiscard]] bool clean() const noexcept {
        if (contacts.groups > 0)
            return false;
        for (std::size_t i = 0; i < nest.rings(); ++i)
            if (nest.kind[i] != RingKind::outer && !(nest.kind[i] == RingKind::hole && nest.winding[i] == 1))
                return false;
        return true;
    }

    MonotoneChains chains;
    std::optional<ChainGrid> grid;
    Contacts contacts;
    Nesting nest;
};

/// Of a ring with material on one side or on both, or on none.
Fate fate(bool outside, bool inside, bool counter_clockwise) noexcept {
    if (outside == inside)
        return Fate::dropped;
    return inside == counter_clockwise ? Fate::kept : Fate::reversed;
}

class Filler {
  public:
    Filler(const Layer& layer, FillRule rule, const Contacts& contacts, const Nesting& nest)
        : layer_(layer), rule_(rule), nest_(nest), groups_(contacts.groups), fates_(layer.rings) {
        assert(contacts.group.size() == layer.rings && nest.order.size() == layer.rings);
        for (const std::uint32_t ring : nest.order) {
            const std::uint32_t group = contacts.group[ring];
            if (group != Contacts::none)
                groups_[group].push_back(ring);
            else if (nest.kind[ring] == RingKind::flat)
                fates_[ring] = Fate::dropped;
            else
                fates_[ring] =
                    fate(is_material(rule, nest.winding[ring]), is_material(rule, nest.winding_inside[ring]),
                         nest.winding_inside[ring] > nest.winding[ring]);
        }
    }

    Filled run() && {
        for (const std::vector<std::uint32_t>& group : groups_)
            fill_group(group);
        result_.rings_dropped = count(Fate::dropped);
        result_.rings_reversed = count(Fate::reversed);
        if (!result_.changed())
            result_.layer = layer_;
        else
            result_.layer = put_together();
        return std::move(result_);
    }

  private:
    [[nodiscard]] std::uint64_t count(Fate wanted) const {
        return static_cast<std::uint64_t>(std::count(fates_.begin(), fates_.end(), wanted));
    }

    /// A group in contact, its rings from left to right.
    void fill_group(const std::vector<std::uint32_t>& group) {
        std::vector<std::span<const Point2>> rings;
        std::vector<std::uint32_t> solid;
        for (const std::uint32_t ring : group) {
            if (nest_.kind[ring] == RingKind::flat) {
                fates_[ring] = Fate::dropped;
            } else {
                rings.push_back(layer_.contour(ring));
                solid.push_back(ring);
            }
        }
        if (solid.empty())
            return;
        // Of the group itself nothing lies below the left end of its first ring.
        const std::int64_t around = nest_.winding[solid.front()];
        if (rule_ != FillRule::evenodd && std::abs(around) > static_cast<std::int64_t>(solid.size())) {
            for (const std::uint32_t ring : solid)
                fates_[ring] = Fate::dropped; // whatever the group adds, one side is like the other
            return;
        }
        if (!grid_)
            grid_.emplace(layer_.points.span());
        if (!has_crossings(layer_of(rings)) && winds_once(rings, around, *grid_))
            return; // boundaries of material that touch
        for (const std::uint32_t ring : solid)
            fates_[ring] = Fate::united;
        ++result_.groups_united;
        result_.rings_united += solid.size();
        for (Ring& ring : filled(rings, rule_, around, *grid_))
            united_.push_back(std::move(ring));
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
    FillRule rule_;
    const Nesting& nest_;
    std::vector<std::vector<std::uint32_t>> groups_;
    std::vector<Fate> fates_;
    std::optional<ClippingGrid> grid_;
    std::vector<Ring> united_;
    Filled result_;
};

} // namespace

std::string_view fill_rule_name(FillRule rule) noexcept {
    switch (rule) {
    case FillRule::nonzero:
        return "nonzero";
    case FillRule::evenodd:
        return "evenodd";
    case FillRule::positive:
        return "positive";
    default:
        return "none";
    }
}

Filled fill(const Layer& layer, FillRule rule) {
    if (rule == FillRule::none)
        return {.layer = layer};
    const Look look(layer);
    if (look.clean())
        return {.layer = layer};
    return Filler(layer, rule, look.contacts, look.nest).run();
}

bool winds_once(std::span<const Layer> parts) {
    std::vector<Box2> boxes;
    for (const Layer& layer : parts) {
        if (layer.rings == 0)
            continue;
        if (layer.points.size() >= Contacts::none)
            return false;
        const Look look(layer);
        if (!look.clean())
            return false;
        Box2 box = look.chains.box(0);
        for (std::size_t i = 1; i < layer.rings; ++i)
            box.add(look.chains.box(i));
        boxes.push_back(box);
    }
    std::sort(boxes.begin(), boxes.end(), [](const Box2& a, const Box2& b) { return a.x0 < b.x0; });
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = i + 1; j < boxes.size() && boxes[j].x0 <= boxes[i].x1; ++j)
            if (boxes[i].meets(boxes[j]))
                return false;
    return true;
}

} // namespace lamella
