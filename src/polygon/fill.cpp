#include "lamella/polygon/fill.hpp"

#include "polygon/overlay.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>
#include <vector>

namespace lamella {

std::string_view fill_rule_name(FillRule rule) noexcept {
    constexpr std::array names{"none", "nonzero", "evenodd", "positive"};
    assert(static_cast<std::size_t>(rule) < names.size());
    return names[static_cast<std::size_t>(rule)];
}

Filled fill(const Layer& layer, FillRule rule, const LayerLimits& limits) {
    if (rule == FillRule::none)
        return {.layer = layer};
    const Overlay overlay(layer, limits);
    if (overlay.clean())
        return {.layer = layer};
    return overlay.filled(Material(rule)).filled;
}

bool winds_once(std::span<const Layer> parts) {
    std::vector<Box2> boxes;
    for (const Layer& layer : parts) {
        if (layer.rings == 0)
            continue;
        if (layer.points.size() >= Contacts::none)
            return false;
        const Overlay overlay(layer);
        if (!overlay.clean())
            return false;
        boxes.push_back(overlay.box());
    }
    std::sort(boxes.begin(), boxes.end(), [](const Box2& a, const Box2& b) { return a.x0 < b.x0; });
    for (std::size_t i = 0; i < boxes.size(); ++i)
        for (std::size_t j = i + 1; j < boxes.size() && boxes[j].x0 <= boxes[i].x1; ++j)
            if (boxes[i].meets(boxes[j]))
                return false;
    return true;
}

} // namespace lamella
