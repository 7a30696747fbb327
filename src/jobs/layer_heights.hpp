#pragma once

// Checks of the heights of layers against one another and against the height of a mesh.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/jobs/verify.hpp"
#include "lamella/slicing/slice.hpp"

#include <optional>
#include <span>

namespace lamella {

/// Finds height_overlaps. An overlap by which the format may have moved heights does not count, nor does a
/// pair of layers with the same bottom and top. The layers may be in any order.
void add_height_overlaps(Findings& found, std::span<const Layer> layers, const Rounding& rounding);

/// Returns the heights covered by layers in any order; nullopt if there are no layers or no triangles. Adds
/// layer_gaps to `found`: a gap counts if the format cannot have caused it by moving heights, and if the mesh
/// has material in the middle of the gap.
[[nodiscard]] std::optional<CoveredHeights> covered_heights(std::span<const Layer> layers, const Mesh& mesh,
                                                            const Rounding& rounding,
                                                            const Execution& execution, Findings& found);

} // namespace lamella
