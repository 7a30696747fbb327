#pragma once

// How a job says where its parts are cut.

#include "lamella/core/execution.hpp"
#include "lamella/core/point.hpp"
#include "lamella/mesh/mesh.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/varying_plan.hpp"

#include <functional>
#include <variant>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Cuts at exactly these z; see plan_listed.
struct ListedPlanes {
    std::vector<double> z = {};
    double single_height = UniformLayers{}.layer_height; ///< of the layer of a single cut
};

/// Layers of the heights of these ranges, and of `layer_height` elsewhere; see plan_by_ranges.
struct HeightRanges {
    std::vector<HeightRange> ranges = {};
    double layer_height = UniformLayers{}.layer_height;
};

/// The ways to cut; a job has one of them.
using Cut = std::variant<UniformLayers, ListedPlanes, HeightRanges, AdaptiveLayers>;

/// Where parts are cut: in which way, where within the thickness of each layer, and which of the layers.
struct Layering {
    Cut cut = {};
    SliceAt at = SliceAt::middle;
    PlaneSelection only = {};
    double snap_mm = 0; ///< see Plan
};

/// The planes that cut what lies in `box`. `mesh` makes it: it is called only where the layers are adaptive.
/// Throws Error{usage} for an impossible plan, and for one whose planes all miss the box.
[[nodiscard]] Plan plan_of(const Layering& layering, const Box3& box, const std::function<Mesh()>& mesh,
                           const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
