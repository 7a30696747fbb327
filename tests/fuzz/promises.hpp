#pragma once

// What the readers promise, whatever the bytes.

#include <lamella/lamella.hpp>

#include <cmath>
#include <cstdlib>

namespace lamella::fuzz {

inline void require(bool promise) {
    if (!promise)
        std::abort();
}

/// Layers in normal form that can be checked.
inline void require_sound(const LayerFile& file) {
    require(!file.parts.empty());
    const LayerStack layers = file.merged();
    require(!layers.empty());
    for (std::size_t i = 0; i < layers.size(); ++i) {
        const Layer& layer = layers[i];
        require(in_normal_form(layer));
        require(layer.bottom <= layer.top);
        require(i == 0 || layers[i - 1].z <= layer.z);
        for (const Point2& p : layer.points)
            require(std::isfinite(p.x) && std::isfinite(p.y));
    }
    static_cast<void>(verify(layers, {}, {.threads = 1}));
}

} // namespace lamella::fuzz
