#include "scan/skin.hpp"

#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/boolean.hpp"
#include "lamella/polygon/offset.hpp"

#include "contour/box2.hpp"
#include "contour/same_height.hpp"
#include "polygon/subtract.hpp"
#include "scan/alongside.hpp"
#include "scan/chosen_rings.hpp"
#include "scan/occupied.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace lamella {

namespace {

/// Returns for each ring of a layer whether it affects the difference to another layer. A ring does if it has
/// no ring alongside in the other layer, or if it is closer than `reach` to such a ring of either layer.
/// `partners` holds for each ring the ring alongside in the other layer. Returns an empty vector if the
/// layers are equal.
std::vector<bool> differing(const Layer& layer, const Layer& other, std::span<const std::uint32_t> partners,
                            double reach) {
    if (layer.rings == other.rings && std::find(partners.begin(), partners.end(), no_ring) == partners.end())
        return {};
    std::vector<bool> alone(other.rings, true);
    std::vector<Box2> boxes(layer.rings, Box2{}); // boxes of pairs of rings
    Occupied occupied(layer);
    const auto add = [&](std::span<const Point2> ring) {
        if (!ring.empty())
            occupied.add(box_of(ring).grown(reach));
    };
    for (std::size_t i = 0; i < layer.rings; ++i) {
        if (partners[i] == no_ring) {
            add(layer.contour(i));
        } else if (!layer.contour(i).empty()) {
            alone[partners[i]] = false;
            boxes[i] = box_of(layer.contour(i));
            boxes[i].add(box_of(other.contour(partners[i])));
        }
    }
    for (std::size_t j = 0; j < other.rings; ++j)
        if (alone[j])
            add(other.contour(j));
    std::vector<bool> counts(layer.rings);
    for (std::size_t i = 0; i < layer.rings; ++i)
        counts[i] = partners[i] == no_ring || occupied.any_within(boxes[i]);
    return counts;
}

/// A neighbour that differs from the layer.
struct Differing {
    std::size_t number;                  ///< 0 for the nearest one
    std::vector<std::uint32_t> partners; ///< the neighbour's ring alongside each ring of the layer
};

/// Upper bound of the relative difference in growth between the farthest and the nearest neighbour.
constexpr double spread = 0.01;

/// Number of neighbours that are subtracted at once. It is small because the rings of each two of them cross
/// one another, too.
constexpr std::size_t most_at_once = 4;

/// Returns the layer minus the intersection of its neighbours, shrunk by half of `narrowest`. So areas
/// narrower than `narrowest` vanish.
///
/// The difference is not computed directly. The layers of a prism are equal except for rounding: they share
/// the corners of the walls, but have other points where edges of triangles slant across the walls. So the
/// layer is shrunk, and each neighbour is grown before it is subtracted, which shrinks the difference. Each
/// neighbour is grown slightly more than the one before it. Then nearly equal rings do not intersect at all,
/// which takes a fraction of the time and leaves no slivers. The layer is shrunk slightly less, so that the
/// skin, when grown again, reaches beyond the outline and leaves no slivers there either.
///
/// Rings alongside each other have the same winding number at a point unless it lies between them; such a
/// point is nearer than half of `narrowest` to one of the rings. So the remaining area lies within rings that
/// have no ring alongside, and only rings near these are processed.
Layer uncovered_area(const Layer& layer, std::span<const ScanLayer> neighbours, double narrowest,
                     const LayerLimits& limits) {
    const auto count = static_cast<double>(neighbours.size());
    const double reach = narrowest * (1 + spread) * OffsetCorners{}.longest_mitre();
    std::vector<Differing> different;
    std::vector<bool> chosen(layer.rings);
    for (std::size_t k = 0; k < neighbours.size(); ++k) {
        if (same_contours(layer, neighbours[k].layer()))
            continue;
        std::vector<std::uint32_t> partners = rings_alongside(layer, neighbours[k].layer(), narrowest,
                                                              LayerBudget(limits, layer.index, layer.z));
        const std::vector<bool> counts = differing(layer, neighbours[k].layer(), partners, reach);
        if (counts.empty())
            continue;
        different.push_back({k, std::move(partners)});
        for (std::size_t i = 0; i < layer.rings; ++i)
            chosen[i] = chosen[i] || counts[i];
    }
    const Layer own = offset(chosen_rings(layer, [&](std::size_t i) { return chosen[i]; }),
                             -narrowest / 2 * (1 - spread), {.limits = limits});
    if (own.rings == 0)
        return {};
    Layer open;
    std::vector<Layer> others;
    for (std::size_t d = 0; d < different.size(); ++d) {
        const Differing& neighbour = different[d];
        const Layer& other = neighbours[neighbour.number].layer();
        std::vector<bool> left_out(other.rings);
        for (std::size_t i = 0; i < layer.rings; ++i)
            if (neighbour.partners[i] != no_ring && !chosen[i])
                left_out[neighbour.partners[i]] = true;
        others.push_back(offset(chosen_rings(other, [&](std::size_t j) { return !left_out[j]; }),
                                narrowest / 2 * (1 + spread * static_cast<double>(neighbour.number) / count),
                                {.limits = limits}));
        if (others.size() < most_at_once && d + 1 < different.size())
            continue;
        const Layer more = subtract_common(own, others, limits);
        open = open.rings == 0 ? more : combine(open, more, BooleanOperation::unite, limits);
        others.clear();
    }
    return open;
}

/// Returns whether two layers adjoin or overlap in height.
bool adjoin(const Layer& a, const Layer& b) noexcept {
    return b.bottom <= a.top + same_height_mm && a.bottom <= b.top + same_height_mm;
}

/// Returns the neighbours before the first gap in height, since the part ends at a gap.
std::span<const ScanLayer> adjoining(const ScanLayer& layer, std::span<const ScanLayer> neighbours) noexcept {
    const ScanLayer* last = &layer;
    std::size_t count = 0;
    while (count < neighbours.size() && adjoin(last->layer(), neighbours[count].layer()))
        last = &neighbours[count++];
    return neighbours.first(count);
}

} // namespace

Skin::Skin(const ScanLayer& layer, std::span<const ScanLayer> neighbours, const SkinRule& rule,
           const LayerLimits& limits) {
    if (rule.layers == 0 || layer.layer().points.empty())
        return;
    neighbours = adjoining(layer, neighbours.first(std::min<std::size_t>(neighbours.size(), rule.layers)));
    if (neighbours.size() < rule.layers) {
        whole_ = true;
        return;
    }
    const Layer open = uncovered_area(layer.layer(), neighbours, rule.narrowest, limits);
    if (open.rings == 0)
        return;
    std::vector<Layer> moved =
        offsets(open, std::array{rule.narrowest / 2, rule.narrowest / 2 + rule.overlap}, {.limits = limits});
    area_ = std::move(moved[0]);
    with_overlap_ = std::move(moved[1]);
}

} // namespace lamella
