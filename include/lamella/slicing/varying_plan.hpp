#pragma once

// Plans whose layers differ in height.

#include "lamella/core/execution.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Height of the layers between `from` and `to`, which are in mm above the bottom of the part.
struct HeightRange {
    double from = 0;
    double to = 0;
    double layer_height = 0;

    friend bool operator==(const HeightRange&, const HeightRange&) = default;
};

/// Layers with the heights of these ranges, and of `layer_height` outside them.
struct HeightRanges {
    std::vector<HeightRange> ranges = {};
    double layer_height = UniformLayers{}.layer_height;
};

/// Returns layers stacked from z_min. Each has the height of the range that contains its bottom, or
/// `layer_height` if no range does. A layer may reach beyond the end of its range. A bottom less than a
/// thousandth of a layer below the beginning or the end of a range counts as being at that height. The last
/// layer is chosen as in `plan_uniform`.
///
/// Throws Error{usage} if a range is empty, begins below 0, overlaps another one or does not ascend, naming
/// the first such range; and in the cases of `plan_uniform`.
[[nodiscard]] Plan plan_by_ranges(double z_min, double z_max, const HeightRanges& heights,
                                  SliceAt slice_at = SliceAt::middle);

/// Layers as high as the slopes of the surface allow. Lengths in mm.
struct AdaptiveLayers {
    double min_height = 0.05;
    double max_height = 0.3;
    /// Largest distance between the steps of the layers and the surface, measured perpendicular to the
    /// surface (cusp height). On a triangle with unit normal n, a layer of height h has cusps of h |n.z|: 0
    /// on a vertical wall, h on a horizontal face.
    double cusp_mm = 0.05;
};

/// Returns layers stacked from the bottom of the mesh. Each is as high as `max_height` and `cusp_mm` allow
/// for every triangle that reaches into it, but never below `min_height`, even if its cusps are then larger.
/// The last layer ends at the top of the mesh, unless it would then be lower than `min_height`.
///
/// One pass over the triangles gathers their slopes by height, in steps of min_height / 4, or of a 2^20th of
/// the part's height if that is more. Next to a change of slope a layer may therefore be slightly lower than
/// necessary. The result is the same for any number of threads. Throws the Error{usage} of `plan_uniform`,
/// and Error{usage} unless 0 < min_height <= max_height and 0 < cusp_mm; Error{limit} as soon as there are
/// more than `most_layers` layers, so that no more are held; Error{cancelled}. O(triangles + s log s) for s
/// steps.
[[nodiscard]] Plan plan_adaptive(const Mesh& mesh, const AdaptiveLayers& layers,
                                 SliceAt slice_at = SliceAt::middle, const Execution& execution = {},
                                 std::uint64_t most_layers = max_layers);

} // namespace lamella
LAMELLA_API_END
