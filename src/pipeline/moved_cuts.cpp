#include "pipeline/moved_cuts.hpp"

#include <algorithm>

namespace lamella {

MovedCuts::MovedCuts(std::span<const Layer> layers, const Rounding& rounding, PlaneRule rule,
                     double direction) {
    std::vector<double> z;
    for (const Layer& layer : layers)
        z.push_back(layer.z + direction * moved_cut(layer, rounding));
    std::vector<double> ascending = z;
    std::sort(ascending.begin(), ascending.end());
    ascending.erase(std::unique(ascending.begin(), ascending.end()), ascending.end());
    plan.rule = rule;
    for (const double at : ascending)
        plan.layers.push_back({plan.layers.size(), at, at, at});
    for (const double at : z)
        plane.push_back(static_cast<std::size_t>(std::lower_bound(ascending.begin(), ascending.end(), at) -
                                                 ascending.begin()));
}

} // namespace lamella
