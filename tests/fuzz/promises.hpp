#pragma once

// Contracts of the readers for any input.

#include <lamella/jobs.hpp>

#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <span>

namespace lamella::fuzz {

inline void require(bool promise) {
    if (!promise)
        std::abort();
}

/// Requires contours of finite points, and hatches of two points each.
inline void require_whole(const Layer& layer, std::span<const Point2> hatches = {}) {
    require(!layer.offsets.empty() && layer.offsets.front() == 0 &&
            layer.offsets.back() == layer.points.size());
    require(layer.rings <= layer.contours());
    for (std::size_t i = 0; i < layer.contours(); ++i)
        require(layer.offsets[i] < layer.offsets[i + 1]);
    require(hatches.size() % 2 == 0);
    for (const std::span<const Point2> points : {layer.points.span(), hatches})
        for (const Point2& p : points)
            require(std::isfinite(p.x) && std::isfinite(p.y));
}

/// Requires layers in normal form, or scan vectors.
inline void require_sound(const LayerFile& file) {
    const std::vector<LayerPart> parts = file.in_memory();
    require(!file.parts.empty());
    for (const LayerPart& part : parts) {
        require(part.hatches.empty() || part.hatches.size() == part.layers.size());
        require(!part.layers.empty() && part.layers.size() == parts.front().layers.size());
        for (std::size_t i = 0; i < part.layers.size(); ++i) {
            const Layer& layer = part.layers[i];
            require_whole(layer, part.hatches_of(i));
            require(part.exposure || in_normal_form(layer));
            require(std::isfinite(layer.bottom) && std::isfinite(layer.z) && std::isfinite(layer.top));
            require(layer.bottom <= layer.top);
            require(i == 0 || part.layers[i - 1].z <= layer.z);
        }
        if (part.exposure) {
            const ParameterSet& set = part.exposure->parameters;
            for (const double value : {set.power_w, set.speed_mm_s, set.jump_speed_mm_s, set.focus_mm,
                                       set.spot_mm, set.mark_delay_us, set.jump_delay_us})
                require(std::isfinite(value));
        }
    }
    const LayerStack layers = file.merged();
    for (const Layer& layer : layers)
        require(in_normal_form(layer) || file.parts.size() == 1);
    static_cast<void>(verify(layers, {}, {.threads = 1}));
    static_cast<void>(verify_vectors(file, {}, {.threads = 1}));
}

} // namespace lamella::fuzz
