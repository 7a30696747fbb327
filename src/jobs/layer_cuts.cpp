#include "jobs/layer_cuts.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lamella {

namespace {

/// Heights whose distance is below this part of the thickness of the layer are one cut.
constexpr double same_cut = 1e-6;

} // namespace

LayerCuts::LayerCuts(const Plan& layers, std::uint32_t count) {
    plan_.rule = layers.rule;
    plan_.snap_mm = layers.snap_mm;
    const auto add = [this](double z, double bottom, double top) {
        plan_.layers.push_back({.index = plan_.layers.size(), .z = z, .bottom = bottom, .top = top});
    };
    for (const PlannedLayer& layer : layers.layers) {
        const double thickness = layer.top - layer.bottom;
        if (!(thickness > 0))
            throw Error(ErrorKind::usage, fmt::format("layer {} has no thickness, which several cuts for its "
                                                      "image need",
                                                      layer.index));
        first_.push_back(static_cast<std::uint32_t>(plan_.layers.size()));
        bool own = false;
        const auto add_own = [&] {
            own = true;
            own_.push_back(static_cast<std::uint32_t>(plan_.layers.size()));
        };
        for (std::uint32_t i = 0; i < count; ++i) {
            const double z = layer.bottom + (i + 0.5) / count * thickness;
            const bool is_own = std::abs(z - layer.z) <= same_cut * thickness;
            if (!own && (is_own || layer.z < z)) {
                add_own();
                if (!is_own)
                    add(layer.z, layer.z, layer.z);
            }
            add(is_own ? layer.z : z, layer.bottom + thickness * i / count,
                layer.bottom + thickness * (i + 1) / count);
        }
        if (!own) {
            add_own();
            add(layer.z, layer.z, layer.z);
        }
    }
    first_.push_back(static_cast<std::uint32_t>(plan_.layers.size()));
}

std::uint32_t LayerCuts::layer_of(std::uint32_t cut) const noexcept {
    const auto above = std::upper_bound(first_.begin(), first_.end(), cut);
    return static_cast<std::uint32_t>(above - first_.begin()) - 1;
}

std::optional<Plane> CutCollector::add(std::uint32_t cut, Plane bodies) {
    const std::uint32_t layer = cuts_.layer_of(cut);
    std::map<std::uint32_t, Plane> all;
    {
        const std::lock_guard lock(mutex_);
        std::map<std::uint32_t, Plane>& arrived = collected_[layer];
        arrived.emplace(cut, std::move(bodies));
        if (arrived.size() < cuts_.of({layer, layer + 1}).size())
            return std::nullopt;
        all = std::move(arrived);
        collected_.erase(layer);
    }
    Plane plane = std::move(all.extract(cuts_.own_of(layer)).mapped());
    for (Layer& part : plane.polylines) {
        const PlannedLayer& planned = layers_.layers[layer];
        part.index = planned.index;
        part.bottom = planned.bottom;
        part.top = planned.top;
    }
    for (auto& [number, other] : all)
        plane.cuts.push_back(std::move(other.polylines));
    return plane;
}

} // namespace lamella
