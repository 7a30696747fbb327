#pragma once

// What layers are held against: those of a mesh, where they may have been cut before a format rounded that.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/pipeline/verify.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <algorithm>
#include <cstddef>
#include <span>
#include <utility>
#include <vector>

namespace lamella {

/// What cut(plan) gives for the plane of each layer: first where the layer is, and where the format rounds,
/// as far below and above as it may have moved the cut.
template <class Cut>
auto at_moved_cuts(std::span<const Layer> layers, const Rounding& rounding, PlaneRule rule, double snap_mm,
                   const Cut& cut) {
    using OfPlane = typename decltype(cut(Plan{}))::value_type;
    std::vector<std::vector<OfPlane>> of_layer(layers.size());
    for (const double direction : {0.0, -1.0, 1.0}) {
        if (direction != 0 && rounding == Rounding{})
            break;
        std::vector<double> z;
        for (const Layer& layer : layers)
            z.push_back(layer.z + direction * moved_cut(layer, rounding));
        std::vector<double> ascending = z;
        std::sort(ascending.begin(), ascending.end());
        ascending.erase(std::unique(ascending.begin(), ascending.end()), ascending.end());
        Plan plan{.layers = {}, .rule = rule, .snap_mm = snap_mm};
        for (const double at : ascending)
            plan.layers.push_back({plan.layers.size(), at, at, at});
        const auto of_plane = cut(plan);
        for (std::size_t i = 0; i < layers.size(); ++i) {
            const auto plane = std::lower_bound(ascending.begin(), ascending.end(), z[i]);
            of_layer[i].push_back(of_plane[static_cast<std::size_t>(plane - ascending.begin())]);
        }
    }
    return of_layer;
}

/// All steps but for `simplify`: which points that leaves out is decided by their last digits, so what it
/// moves is granted instead.
inline LayerSteps steps_to_repeat(LayerSteps steps) {
    steps.simplify_mm = 0;
    return steps;
}

/// The limit of mitres, and where the format rounds, one below and one above it: at corners of that very
/// angle, 60 degrees by default, rounding decides whether they are cut off.
inline std::vector<double> limits_of_mitres(double limit, const Rounding& rounding) {
    constexpr double share = 0.01;
    return rounding == Rounding{}
               ? std::vector{limit}
               : std::vector{limit, std::max(1.0, (1 - share) * limit), (1 + share) * limit};
}

/// The layers of the mesh, after these steps.
inline LayerStack layers_of(const VerifyOptions& options, const Plan& plan, const LayerSteps& steps,
                            const Execution& execution) {
    LayerStack layers =
        options.subtracts() ? slice(*options.plate, plan, execution) : slice(*options.mesh, plan, execution);
    LayerChanges changes;
    return steps.any() ? take_steps(steps, std::move(layers), changes, execution) : layers;
}

} // namespace lamella
