#include "lamella/polygon/boolean.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/fill.hpp"

#include "contour/box2.hpp"
#include "polygon/material.hpp"
#include "polygon/overlay.hpp"
#include "polygon/subtract.hpp"
#include "polygon/windings.hpp"

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

namespace {

using Rings = std::vector<std::span<const Point2>>;

/// The rings of two layers in normal form, divided into rings that are, bit for bit, in both layers, and
/// rings in only one of them.
struct Shares {
    Shares(const Layer& a, const Layer& b) {
        std::size_t i = 0;
        std::size_t j = 0;
        while (i < a.rings && j < b.rings)
            if (stands_before(a.contour(i), b.contour(j))) {
                first.push_back(a.contour(i++));
            } else if (stands_before(b.contour(j), a.contour(i))) {
                second.push_back(b.contour(j++));
            } else {
                both.push_back(a.contour(i++));
                ++j;
            }
        for (; i < a.rings; ++i)
            first.push_back(a.contour(i));
        for (; j < b.rings; ++j)
            second.push_back(b.contour(j));
    }

    Rings both;
    Rings first;
    Rings second;
};

/// Removes common rings outside of the box of the rings that are in only one layer. Outside of this box the
/// winding numbers of both layers are equal, so these rings do not affect the result.
void drop_far(Shares& rings) {
    std::optional<Box2> box;
    for (const Rings* alone : {&rings.first, &rings.second})
        for (const std::span<const Point2> ring : *alone)
            if (!ring.empty() && box)
                box->add(box_of(ring));
            else if (!ring.empty())
                box = box_of(ring);
    std::erase_if(rings.both, [&](std::span<const Point2> ring) {
        return ring.empty() || !box || !box_of(ring).meets(*box);
    });
}

/// Builds a layer of these rings with the heights and open chains of `first`.
Layer with_header_and_chains_of(const Layer& first, const Rings& rings) {
    Layer layer{.index = first.index, .z = first.z, .bottom = first.bottom, .top = first.top};
    std::vector<Point2> points;
    const auto add = [&](std::span<const Point2> contour) {
        points.insert(points.end(), contour.begin(), contour.end());
        layer.offsets.push_back(points.size());
    };
    for (const std::span<const Point2> ring : rings)
        add(ring);
    for (std::size_t i = first.rings; i < first.contours(); ++i)
        add(first.contour(i));
    layer.points = PointArray(std::move(points));
    layer.rings = rings.size();
    return layer;
}

/// `least`: see `Material`.
Layer combined(const Layer& first, const Layer& second, BooleanOperation operation, std::int64_t least,
               const LayerLimits& limits, Closeness closeness = Closeness::contact) {
    const Layer a = normal_form(first);
    const Layer b = normal_form(second);
    Shares shares(a, b);
    const bool same = shares.first.empty() && shares.second.empty();
    if (operation == BooleanOperation::subtract || operation == BooleanOperation::exclude) {
        if (least == 1)
            drop_far(shares); // for these operations common rings cancel there, no matter what is around them
    } else if (same) {
        return fill(a, FillRule::positive, limits).layer;
    }
    Rings rings = std::move(shares.both);
    std::vector<Windings> turns(rings.size(), {1, 1});
    rings.insert(rings.end(), shares.first.begin(), shares.first.end());
    turns.resize(rings.size(), {1, 0});
    rings.insert(rings.end(), shares.second.begin(), shares.second.end());
    turns.resize(rings.size(), {0, 1});
    const Layer layer = with_header_and_chains_of(a, rings);
    return normal_form(Overlay(layer, std::move(turns), limits, most_crossings, closeness)
                           .filled(Material(operation, least))
                           .filled.layer);
}

} // namespace

Layer combine(const Layer& first, const Layer& second, BooleanOperation operation,
              const LayerLimits& limits) {
    return combined(first, second, operation, 1, limits);
}

Layer subtract_body(const Layer& layer, const Layer& body, const LayerLimits& limits) {
    return combined(layer, body, BooleanOperation::subtract, 1, limits, Closeness::rounding);
}

Layer subtract_common(const Layer& layer, std::span<const Layer> others, const LayerLimits& limits) {
    assert(!others.empty());
    return combined(layer, merged(others), BooleanOperation::subtract,
                    static_cast<std::int64_t>(others.size()), limits);
}

} // namespace lamella
