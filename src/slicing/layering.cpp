#include "lamella/slicing/layering.hpp"

#include "lamella/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace lamella {
namespace {

/// Returns whether a plane at z can cut anything in the box, by the rule of the plane.
bool meets(double z, PlaneRule rule, double snap_mm, const Box3& box) {
    return rule == PlaneRule::section_above ? box.min.z <= z + snap_mm && z + snap_mm < box.max.z
                                            : box.min.z < z - snap_mm && z - snap_mm <= box.max.z;
}

/// Returns the plan restricted to the selected layers. Throws Error{usage} if none of them meets the box.
Plan selected(const Layering& layering, Plan plan, const Box3& box) {
    const PlaneSelection& only = layering.only;
    std::erase_if(plan.layers, [&](const PlannedLayer& layer) {
        const auto& z_range = only.z_range;
        const auto& index_range = only.index_range;
        return (z_range && !(z_range->first <= layer.z && layer.z <= z_range->second)) ||
               (index_range && !(index_range->first <= layer.index && layer.index < index_range->second));
    });
    if (std::none_of(plan.layers.begin(), plan.layers.end(), [&](const PlannedLayer& layer) {
            return meets(layer.z, plan.rule, layering.snap_mm, box);
        }))
        throw Error(
            ErrorKind::usage,
            fmt::format("none of the planes meets the part, which reaches from z = {:.6g} to {:.6g} mm",
                        box.min.z, box.max.z));
    return plan;
}

struct Planner {
    const Layering& layering;
    const Box3& box;
    const std::function<Mesh()>& mesh;
    const Execution& execution;
    std::uint64_t most_layers;

    Plan operator()(const UniformLayers& layers) const {
        return plan_uniform(box.min.z, box.max.z, layers, layering.at, layering.only);
    }
    Plan operator()(const ListedPlanes& planes) const {
        return selected(layering, plan_listed(planes.z, layering.at, planes.single_height), box);
    }
    Plan operator()(const HeightRanges& heights) const {
        return selected(layering, plan_by_ranges(box.min.z, box.max.z, heights, layering.at), box);
    }
    Plan operator()(const AdaptiveLayers& layers) const {
        return selected(layering, plan_adaptive(mesh(), layers, layering.at, execution, most_layers), box);
    }
};

} // namespace

Plan plan_of(const Layering& layering, const Box3& box, const std::function<Mesh()>& mesh,
             const Execution& execution, std::uint64_t most_layers) {
    Plan plan = std::visit(Planner{layering, box, mesh, execution, most_layers}, layering.cut);
    plan.snap_mm = layering.snap_mm;
    check(plan);
    return plan;
}

} // namespace lamella
