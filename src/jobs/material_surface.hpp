#pragma once

// The surfaces that bound the material of a plate, for layers whose heights follow slopes.

#include "lamella/core/execution.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/mesh/mesh.hpp"

namespace lamella {

/// Returns the triangles of all parts as one mesh. The mesh includes triangles of negative volumes, clipped
/// to the boxes of the parts from which these are subtracted, since they may bound material there. The box of
/// the result is that of the parts.
[[nodiscard]] Mesh material_surface(const Plate& plate, const Execution& execution = {});

} // namespace lamella
