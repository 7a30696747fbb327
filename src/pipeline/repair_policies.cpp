#include "lamella/pipeline/repair_policies.hpp"

#include <utility>

namespace lamella {

RepairedMesh repaired(const Mesh& mesh, const RepairPolicies& policies, const Execution& execution) {
    if (!policies.change_the_mesh())
        return {mesh, {}};
    MeshRepairs repairs;
    IndexedMesh changed = weld(mesh, execution);
    if (policies.weld_tolerance_mm) {
        repairs.welded = weld_within(changed, *policies.weld_tolerance_mm, execution);
        changed = std::exchange(repairs.welded->mesh, {});
    }
    if (policies.drop_duplicates) {
        repairs.dropped = drop_duplicates(changed, execution);
        changed = std::exchange(repairs.dropped->mesh, {});
    }
    if (policies.orient) {
        repairs.oriented = orient(changed, execution);
        changed = std::exchange(repairs.oriented->mesh, {});
    }
    return {Mesh(std::move(changed)), std::move(repairs)};
}

} // namespace lamella
