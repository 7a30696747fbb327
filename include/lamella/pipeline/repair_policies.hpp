#pragma once

// What to do about meshes and layers that are not sound: each policy by itself, none unless asked for.

#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/repair.hpp"

#include <cstdint>
#include <optional>

LAMELLA_API_BEGIN
namespace lamella {

struct RepairPolicies {
    std::optional<double> weld_tolerance_mm; ///< weld_within
    bool drop_duplicates = false;            ///< drop_duplicates
    bool orient = false;                     ///< orient
    std::optional<double> close_gaps_mm;     ///< close_gaps, of every layer

    [[nodiscard]] bool change_the_mesh() const noexcept {
        return weld_tolerance_mm || drop_duplicates || orient;
    }
};

/// What the policies of the mesh did, in the order in which they ran; their meshes are left out.
struct MeshRepairs {
    std::optional<ToleranceWeld> welded;
    std::optional<DroppedDuplicates> dropped;
    std::optional<OrientedMesh> oriented;
};

/// The mesh, welded exactly, after the policies that change meshes: first the tolerance, then duplicates,
/// then orientation. Passed through where there are none. Throws what these throw.
[[nodiscard]] Mesh repaired(const Mesh& mesh, const RepairPolicies& policies, MeshRepairs& repairs,
                            const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
