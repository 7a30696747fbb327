#pragma once

#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/repair_policies.hpp"
#include "lamella/mesh/transform.hpp"

#include "repairs.hpp"
#include "source_mesh.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace lamella::python {

/// Meshes at their positions, which are sliced on common planes.
struct SourcePlate {
    Plate placed; ///< before repairs; from it planes are planned
    Plate mended; ///< the same bodies after repairs
    /// True if the layers of parts stay apart; otherwise all parts are one.
    bool apart = false;
    std::string label;               ///< of the parts together
    Transform matrix;                ///< of all parts; see MeshOrigin
    std::vector<Transform> matrices; ///< of each part, if they stay apart
    Repairs repairs;

    [[nodiscard]] bool several() const noexcept { return apart && placed.parts.size() > 1; }
};

using PlatePointer = std::shared_ptr<SourcePlate>;

} // namespace lamella::python
