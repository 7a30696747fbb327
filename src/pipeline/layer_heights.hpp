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

/// Returns the number of layers, in any order, that begin within the height of another one, by more than the
/// format may have moved heights; layers that share all of it do not count. Describes them in `findings`.
[[nodiscard]] std::uint64_t overlapping_heights(std::span<const Layer> layers, const Rounding& rounding,
                                                std::vector<std::string>& findings);

/// Returns the heights covered by layers in any order; none if there are no layers, or no triangles. A gap is
/// larger than the format may have moved heights, and the mesh has material in its middle. Describes gaps in
/// `findings`.
[[nodiscard]] std::optional<CoveredHeights> covered_heights(std::span<const Layer> layers, const Mesh& mesh,
                                                            const Rounding& rounding,
                                                            const Execution& execution,
                                                            std::vector<std::string>& findings);

} // namespace lamella
