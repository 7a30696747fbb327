#include "lamella/polygon/inverted_rings.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/contour/normal_form.hpp"
#include "lamella/polygon/fill.hpp"

#include "polygon/holes_in_material.hpp"
#include "polygon/reversed_rings.hpp"

#include <cassert>
#include <cstddef>
#include <span>

namespace lamella {

// Reversed rings bound material where the winding number is negative.
InvertedRings inverted_rings(const Layer& layer, const Rounding& rounding, InversionSearch search,
                             const LayerLimits& limits) {
    const Rounding at_least{.step_mm = rounding.step_mm, .single_precision = true};
    InvertedRings inverted;
    assert(search == InversionSearch::full || in_normal_form(layer));
    if (search == InversionSearch::quick && holes_lie_in_material(layer, at_least))
        return inverted;
    const Layer positions = fill(with_rings_reversed(layer), FillRule::positive, limits).layer;
    for (std::size_t i = 0; i < positions.rings; ++i)
        if (const std::span<const Point2> ring = positions.contour(i); !orientation_is_lost(ring, at_least))
            inverted += {.rings = 1, .area_mm2 = ring_area(ring), .at = ring.front()};
    return inverted;
}

} // namespace lamella
