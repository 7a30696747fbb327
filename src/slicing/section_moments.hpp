#pragma once

// Area and moments of the sections of a mesh, computed from its triangles.

#include "lamella/core/execution.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/plan.hpp"

#include "contour/area_moments.hpp"

#include <vector>

namespace lamella {

/// Returns the moments of the section at each plane of the plan, around `origin`, which should be near the
/// part. See `section_areas`.
[[nodiscard]] std::vector<AreaMoments> section_moments(const Mesh& mesh, const Plan& plan,
                                                       const Point2& origin, const Execution& execution);

} // namespace lamella
