#include "lamella/polygon/inverted_rings.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/fill.hpp"
#include "lamella/polygon/nesting.hpp"

#include "polygon/holes_in_material.hpp"
#include "polygon/reversed_rings.hpp"

#include <cassert>
#include <cmath>
#include <cstdint>
#include <span>

namespace lamella {

namespace {

/// Returns the inverted rings that bound one body of the reversed layer. Rings that cancel, such as those of
/// a knife edge that a plane touches, have nothing between them, or a film as thin as the rounding.
InvertedRings inverted_rings_of(const Layer& reversed, const Polygon& body, const Rounding& rounding) {
    const std::span<const Point2> outer = reversed.contour(body.outer);
    InvertedRings inverted{.rings = 1, .area_mm2 = ring_area(outer), .at = outer.front()};
    double lost = area_of_lost_orientation(outer, rounding);
    for (const std::uint32_t hole : body.holes) {
        const std::span<const Point2> ring = reversed.contour(hole);
        inverted.area_mm2 += ring_area(ring);
        inverted.rings += orientation_is_lost(ring, rounding) ? 0 : 1;
        lost += area_of_lost_orientation(ring, rounding);
    }
    return std::abs(inverted.area_mm2) <= lost ? InvertedRings{} : inverted;
}

} // namespace

// Reversed rings bound material where the winding number is negative.
InvertedRings inverted_rings(const Layer& layer, const Rounding& rounding, InversionSearch search,
                             const LayerLimits& limits) {
    const Rounding at_least{.step_mm = rounding.step_mm, .single_precision = true};
    InvertedRings inverted;
    assert(search == InversionSearch::full || in_normal_form(layer));
    if (search == InversionSearch::quick && holes_lie_in_material(layer, at_least))
        return inverted;
    const Layer reversed = fill(with_rings_reversed(layer), FillRule::positive, limits).layer;
    if (reversed.rings > 0)
        for (const Polygon& body : polygons(nesting(reversed)))
            inverted += inverted_rings_of(reversed, body, at_least);
    return inverted;
}

} // namespace lamella
