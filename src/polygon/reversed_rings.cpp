#include "polygon/reversed_rings.hpp"

#include <cstddef>
#include <span>

namespace lamella {

Layer with_rings_reversed(const Layer& layer) {
    LayerBuilder builder;
    for (std::size_t i = 0; i < layer.rings; ++i) {
        const std::span<const Point2> ring = layer.contour(i);
        for (auto p = ring.rbegin(); p != ring.rend(); ++p)
            builder.add_point(*p);
        builder.end_contour(true);
    }
    return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
}

} // namespace lamella
