#pragma once

// Repairs of unsound meshes and layers. Each policy is independent of the others and off by default.

#include "lamella/contour/close_gaps.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/mesh/repair.hpp"
#include "lamella/mesh/transform.hpp"
#include "lamella/meshes/mesh_file.hpp"

#include <cstdint>
#include <optional>
#include <vector>

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

/// Results of the policies that change the mesh, in the order in which they ran, without the meshes.
struct MeshRepairs {
    std::optional<ToleranceWeld> welded;
    std::optional<DroppedDuplicates> dropped;
    std::optional<OrientedMesh> oriented;
};

struct RepairedMesh {
    Mesh mesh;
    MeshRepairs repairs;
};

/// Returns the mesh, welded exactly, after the policies that change meshes: first the tolerance, then
/// duplicates, then orientation. Returns it unchanged if there are none. Throws the errors of the policies.
[[nodiscard]] RepairedMesh repaired(const Mesh& mesh, const RepairPolicies& policies,
                                    const Execution& execution = {});

struct RepairedPlate {
    Plate plate;                      ///< the boxes of parts and of the plate are those before the repairs
    std::vector<MeshRepairs> repairs; ///< one for each of Plate::shapes; empty if no policy changes meshes
};

/// Repairs each shape of the plate in the same way. Throws the same errors, and Error{input} if nothing is
/// left of a shape.
[[nodiscard]] RepairedPlate repaired(Plate plate, const RepairPolicies& policies,
                                     const Execution& execution = {});

struct RepairedFile {
    MeshFile file;                    ///< in millimetres, with the placement applied; without warnings
    std::vector<MeshRepairs> repairs; ///< those of RepairedPlate
};

/// Repairs the meshes of a file at their placement on the plate, as a job does. `unit_mm` and `placement` are
/// those of PlateInput.
[[nodiscard]] RepairedFile repaired(const MeshFile& file, std::optional<double> unit_mm,
                                    const Transform& placement, const RepairPolicies& policies,
                                    const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
