#include "lamella/polygon/selection.hpp"

#include "lamella/contour/measure.hpp"
#include "lamella/core/error.hpp"
#include "lamella/polygon/nesting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace lamella {

namespace {

/// Returns a layer of the open chains and of the rings for which wanted(ring) is true, in normal form if the
/// given layer was.
template <class Wanted>
Layer selected(const Layer& layer, const Wanted& wanted) {
    std::vector<bool> keep(layer.contours(), true);
    for (std::size_t i = 0; i < layer.rings; ++i)
        keep[i] = wanted(i);
    if (std::find(keep.begin(), keep.end(), false) == keep.end())
        return layer;
    LayerBuilder builder;
    for (std::size_t i = 0; i < layer.contours(); ++i)
        if (keep[i])
            builder.add_contour(layer.contour(i), layer.closed(i));
    return builder.finish(layer.index, layer.z, layer.bottom, layer.top);
}

} // namespace

Layer without_small_rings(const Layer& layer, double mm2) {
    if (!(mm2 >= 0))
        throw Error(
            ErrorKind::usage,
            fmt::format("rings below an area of {} mm^2 cannot be dropped; it must be 0 or more", mm2));
    return selected(layer, [&](std::size_t ring) { return std::abs(ring_area(layer.contour(ring))) >= mm2; });
}

Layer largest_body(const Layer& layer) {
    if (layer.rings < 2)
        return layer;
    const Nesting nest = nesting(layer);
    std::uint32_t largest = Nesting::none;
    double largest_area = 0;
    for (std::uint32_t i = 0; i < nest.rings(); ++i)
        if (nest.body[i] == i) {
            const double area = ring_area(layer.contour(i));
            if (largest == Nesting::none || area > largest_area) {
                largest = i;
                largest_area = area;
            }
        }
    if (largest == Nesting::none)
        return layer; // no ring bounds material
    return selected(layer, [&](std::size_t ring) { return nest.body[ring] == largest; });
}

} // namespace lamella
