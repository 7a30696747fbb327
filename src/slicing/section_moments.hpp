#pragma once

// Where the sections of a mesh lie, straight from its triangles.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/plan.hpp"

#include "contour/area_moments.hpp"

#include <vector>

namespace lamella {

/// As `section_areas`, one for each layer of the plan. Moments are about `origin`, which should be near the
/// part.
[[nodiscard]] std::vector<AreaMoments> section_moments(const Mesh& mesh, const Plan& plan,
                                                       const Point2& origin, const Execution& execution);

} // namespace lamella
