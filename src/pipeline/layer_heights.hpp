#pragma once

// Checks of the heights of layers against one another and against the height of a mesh.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"
#include "lamella/pipeline/verify.hpp"
#include "lamella/slicing/slice.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// Returns the number of layers that begin within the height of another layer. An overlap by which the format
/// may have moved heights does not count, nor does a pair of layers with the same bottom and top. The layers
/// may be in any order. Describes the overlaps in `findings`.
[[nodiscard]] std::uint64_t overlapping_heights(std::span<const Layer> layers, const Rounding& rounding,
                                                std::vector<std::string>& findings);

/// Returns the heights covered by layers in any order; nullopt if there are no layers or no triangles. A gap
/// counts if the format cannot have caused it by moving heights, and if the mesh has material in the middle
/// of the gap. Describes the gaps in `findings`.
[[nodiscard]] std::optional<CoveredHeights> covered_heights(std::span<const Layer> layers, const Mesh& mesh,
                                                            const Rounding& rounding,
                                                            const Execution& execution,
                                                            std::vector<std::string>& findings);

} // namespace lamella
