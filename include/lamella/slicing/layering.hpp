#pragma once

// Layerings: the settings that define the layers of a job.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/varying_plan.hpp"

#include <cstdint>
#include <functional>
#include <variant>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Cuts at exactly these heights; see plan_listed.
struct ListedPlanes {
    std::vector<double> z = {};
    double single_height = UniformLayers{}.layer_height; ///< height of the layer if there is a single cut
};

/// The methods of cutting; a job uses one of them.
using Cut = std::variant<UniformLayers, ListedPlanes, HeightRanges, AdaptiveLayers>;

/// The cuts of a job: the method, the position of each cut within its layer, and the selected layers.
struct Layering {
    Cut cut = {};
    SliceAt at = SliceAt::middle;
    PlaneSelection only = {};
    double snap_mm = 0; ///< see Plan
};

/// Returns the plan for a part with the bounding box `box`. Calls `mesh` only for adaptive layers. Throws
/// Error{usage} for an impossible plan, and if no plane meets the box. `most_layers` is that of
/// plan_adaptive.
[[nodiscard]] Plan plan_of(const Layering& layering, const Box3& box, const std::function<Mesh()>& mesh,
                           const Execution& execution = {}, std::uint64_t most_layers = max_layers);

} // namespace lamella
LAMELLA_API_END
