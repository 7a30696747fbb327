#include "scan/skin.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/offset.hpp"

#include "polygon/box2.hpp"
#include "scan/alongside.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Which cells of a coarse grid over a layer something lies in, so that what is far from it is known for
/// that. What is beyond the layer counts as at its edge.
class Occupied {
  public:
    explicit Occupied(const Layer& layer) : whole_(box_of(layer.points.span())) {}

    void add(const Box2& box) {
        for_rows(box, [](std::uint64_t& row, std::uint64_t columns) {
            row |= columns;
            return true;
        });
    }
    /// Whether there may be something within a box.
    [[nodiscard]] bool any_within(const Box2& box) {
        return !for_rows(box, [](std::uint64_t& row, std::uint64_t columns) { return (row & columns) == 0; });
    }

  private:
    static constexpr unsigned side = 64;

    static unsigned cell(double along, double extent) noexcept {
        const double cells = along / extent * side;
        return !(cells > 0) ? 0 : cells >= side ? side - 1 : static_cast<unsigned>(cells);
    }
    /// Calls `visit` for all rows of a box, with bits for its columns, until that is false.
    template <class Visit>
    bool for_rows(const Box2& box, const Visit& visit) {
        const unsigned first = cell(box.x0 - whole_.x0, whole_.width());
        const unsigned last = cell(box.x1 - whole_.x0, whole_.width());
        const std::uint64_t columns = (~std::uint64_t{0} >> (side - 1 - (last - first))) << first;
        const unsigned last_row = cell(box.y1 - whole_.y0, whole_.height());
        for (unsigned row = cell(box.y0 - whole_.y0, whole_.height()); row <= last_row; ++row)
            if (!visit(rows_[row], columns))
                return false;
        return true;
    }

    Box2 whole_;
    std::array<std::uint64_t, side> rows_{};
};

/// Some rings of a layer, in their order.
template <class Chosen>
Layer rings_of(const Layer& layer, const Chosen& chosen) {
    LayerBuilder builder;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        if (!chosen(i))
            continue;
        for (const Point2& p : layer.contour(i))
            builder.add_point(p);
        builder.end_contour(true);
    }
    return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
}

/// The rings of an area that may have to do with another one, and those that do not.
struct Apart {
    Apart(const Layer& area, const Layer& other) {
        Occupied occupied(area);
        for (std::size_t i = 0; i < other.rings; ++i)
            occupied.add(box_of(other.contour(i)));
        std::vector<bool> chosen(area.rings);
        for (std::size_t i = 0; i < area.rings; ++i)
            chosen[i] = occupied.any_within(box_of(area.contour(i)));
        near = rings_of(area, [&](std::size_t i) { return chosen[i]; });
        far = rings_of(area, [&](std::size_t i) { return !chosen[i]; });
    }

    Layer near;
    Layer far;
};

/// Of two layers the rings that have none alongside in the other one, and what is closer to these than
/// `reach`. `partners`: for each ring of the first layer that of the second one.
std::pair<Layer, Layer> differing(const Layer& first, const Layer& second,
                                  std::span<const std::uint32_t> partners, double reach) {
    if (first.rings == second.rings && std::find(partners.begin(), partners.end(), no_ring) == partners.end())
        return {};
    std::vector<bool> of_first(first.rings, true);
    std::vector<bool> of_second(second.rings, true);
    std::vector<Box2> boxes(first.rings, Box2{}); // of pairs
    Occupied occupied(first);
    const auto add = [&](std::span<const Point2> ring) {
        if (!ring.empty())
            occupied.add(box_of(ring).grown(reach));
    };
    for (std::size_t i = 0; i < first.rings; ++i) {
        if (partners[i] == no_ring) {
            add(first.contour(i));
        } else if (!first.contour(i).empty()) {
            of_second[partners[i]] = false;
            boxes[i] = box_of(first.contour(i));
            boxes[i].add(box_of(second.contour(partners[i])));
        }
    }
    for (std::size_t j = 0; j < second.rings; ++j)
        if (of_second[j])
            add(second.contour(j));
    for (std::size_t i = 0; i < first.rings; ++i)
        if (partners[i] != no_ring)
            of_first[i] = of_second[partners[i]] = occupied.any_within(boxes[i]);
    return {rings_of(first, [&](std::size_t i) { return of_first[i]; }),
            rings_of(second, [&](std::size_t j) { return of_second[j]; })};
}

/// What is left of a layer without what a neighbour has, grown.
///
/// Not what the layer has and the intersection of its neighbours has not: walls of a prism have their corners
/// in the same places on all layers, and others where edges slant across them, so its layers are the same but
/// for roundings. What neighbours have is grown before it is taken away, and what is left is grown by as
/// much: so such rings do not meet at all, which takes a hundredth of the time, and no slivers are left.
///
/// Rings alongside each other wind around a place alike, unless it lies between them, and then it is covered
/// by what is grown. So whatever is left lies within rings that have none alongside, and only what is near to
/// these is looked at.
Layer left_open(const Layer& layer, const Layer& neighbour, std::span<const std::uint32_t> partners,
                double grown) {
    const auto [own, other] = differing(layer, neighbour, partners, grown * OffsetCorners{}.mitre_limit);
    if (own.rings == 0 || other.rings == 0)
        return own;
    return combine(own, offset(other, grown), BooleanOperation::subtract);
}

Layer open_of(const Layer& layer, std::span<const Layer> neighbours, double grown) {
    const double step = grown / static_cast<double>(neighbours.size());
    std::vector<std::uint32_t> partners(
        layer.rings); // in the neighbour that is looked at, from layer to layer
    std::iota(partners.begin(), partners.end(), 0U);
    const Layer* nearer = &layer;
    Layer all;
    for (const Layer& neighbour : neighbours) {
        const std::vector<std::uint32_t> next = rings_alongside(*nearer, neighbour, step);
        nearer = &neighbour;
        for (std::uint32_t& partner : partners)
            partner = partner == no_ring ? no_ring : next[partner];
        Layer open = left_open(layer, neighbour, partners, grown);
        if (all.rings == 0)
            all = std::move(open);
        else if (open.rings > 0)
            all = combine(all, open, BooleanOperation::unite);
    }
    return all;
}

} // namespace

Skin::Skin(const Layer& layer, std::span<const Layer> neighbours, const SkinRule& rule) {
    if (rule.layers == 0 || layer.points.empty())
        return;
    if (neighbours.size() < rule.layers) {
        whole_ = true; // the part ends there
        return;
    }
    const Layer open = open_of(layer, neighbours.first(rule.layers), rule.narrowest);
    if (open.rings == 0)
        return;
    std::vector<Layer> moved = offsets(open, std::array{rule.narrowest, rule.narrowest + rule.overlap});
    skin_ = std::move(moved[0]);
    with_overlap_ = std::move(moved[1]);
}

Layer Skin::of(const Layer& area) const {
    if (whole_)
        return area;
    if (skin_.rings == 0 || area.rings == 0)
        return {};
    return combine(Apart(area, with_overlap_).near, with_overlap_, BooleanOperation::intersect);
}

Layer Skin::rest_of(const Layer& area) const {
    if (whole_)
        return {};
    if (skin_.rings == 0 || area.rings == 0)
        return area;
    const Apart apart(area, skin_);
    Layer rest = combine(apart.near, skin_, BooleanOperation::subtract);
    return apart.far.rings == 0 ? rest : normal_form(merged(std::array{std::move(rest), apart.far}));
}

} // namespace lamella
