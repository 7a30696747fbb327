#pragma once

// The surfaces that bound the material of a plate, for layers whose heights follow slopes.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/pipeline/plate.hpp"

namespace lamella {

/// Returns the triangles of all parts as one mesh, and those of negative volumes as far as they lie in the
/// box of a part from which they are subtracted: there they may bound material. The box of the result is that
/// of the parts.
[[nodiscard]] Mesh material_surface(const Plate& plate, const Execution& execution = {});

} // namespace lamella
