#pragma once

// Layers of some rings of another layer.

#include "lamella/contour/layer.hpp"
#include "lamella/polygon/nesting.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {

/// Returns the rings i of a layer for which chosen(i) is true, in their order.
template <class Chosen>
[[nodiscard]] Layer chosen_rings(const Layer& layer, const Chosen& chosen) {
    LayerBuilder builder;
    for (std::size_t i = 0; i < layer.rings; ++i)
        if (chosen(i))
            builder.add_contour(layer.contour(i), true);
    return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
}

/// Returns the rings of a body, its outer ring first. They keep their order if the layer is in normal form
/// and the body does not overlap others: an outer ring stands before its holes.
[[nodiscard]] inline Layer rings_of(const Layer& layer, const Polygon& body) {
    LayerBuilder builder;
    builder.add_contour(layer.contour(body.outer), true);
    for (const std::uint32_t hole : body.holes)
        builder.add_contour(layer.contour(hole), true);
    return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
}

/// Marks the rings of a body.
inline void choose(const Polygon& body, std::vector<bool>& chosen) {
    chosen[body.outer] = true;
    for (const std::uint32_t hole : body.holes)
        chosen[hole] = true;
}

} // namespace lamella
