#pragma once

// How layers lie on one another, and what they cover of the height of a mesh.

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

/// How many layers, in any order, begin within the height of another one, by more than the format may have
/// moved heights; not those that share all of it. Tells of them in `findings`.
[[nodiscard]] std::uint64_t overlapping_heights(std::span<const Layer> layers, const Rounding& rounding,
                                                std::vector<std::string>& findings);

/// Of layers in any order; none without layers, and of a mesh without triangles. A gap is one of more
/// than the format may have moved heights by, in the middle of which the mesh has material. Tells of gaps in
/// `findings`.
[[nodiscard]] std::optional<CoveredHeights> covered_heights(std::span<const Layer> layers, const Mesh& mesh,
                                                            const Rounding& rounding,
                                                            const Execution& execution,
                                                            std::vector<std::string>& findings);

} // namespace lamella
