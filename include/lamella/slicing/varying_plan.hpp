#pragma once

// Plans whose layers differ in height.

#include "lamella/core/execution.hpp"
#include "lamella/slicing/plan.hpp"
#include "lamella/slicing/slice.hpp"

#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// From `from` to `to`, in mm above the bottom of the part, layers are so high.
struct HeightRange {
    double from = 0;
    double to = 0;
    double layer_height = 0;

    friend bool operator==(const HeightRange&, const HeightRange&) = default;
};

/// Layers stacked from z_min, each of the height of the range that its bottom lies in, and of `layer_height`
/// where there is none: a layer is not cut short where a range ends. A bottom that is less than a thousandth
/// of a layer below the end of a range counts as at it. Which last layer exists is decided as in
/// `plan_uniform`.
///
/// Throws Error{usage} when ranges are empty, overlap or do not ascend, naming the first offender, for
/// heights that are not positive finite numbers, when no layer is left, or when there would be more than 2^31
/// - 2.
[[nodiscard]] Plan plan_by_ranges(double z_min, double z_max, const std::vector<HeightRange>& ranges,
                                  double layer_height, SliceAt slice_at = SliceAt::middle);

/// Layers as high as the slopes of the surface allow. Lengths in mm.
struct AdaptiveLayers {
    double min_height = 0.05;
    double max_height = 0.3;
    /// How far the steps between layers may stand off the surface, measured across it. A layer of height h
    /// makes cusps of h |n.z| on a triangle of the unit normal n: none on an upright wall, h on a level one.
    double cusp_mm = 0.05;
};

/// Layers stacked from the bottom of the mesh, each as high as `max_height` and `cusp_mm` allow for every
/// triangle that reaches into it, but never below `min_height`, even where its cusps are larger then. The
/// last one ends at the top, where that leaves it no lower than `min_height`.
///
/// Slopes are gathered in one pass over the triangles, by height, in steps of min_height / 4 (of a 2^20th of
/// the part's height, where that is more): next to a step a layer may come out a little lower than it could
/// be. O(triangles + height / min_height), the same for any number of threads. Throws Error{usage} as
/// `plan_uniform`, and unless 0 < min_height <= max_height and 0 < cusp_mm.
[[nodiscard]] Plan plan_adaptive(const Mesh& mesh, const AdaptiveLayers& layers,
                                 SliceAt slice_at = SliceAt::middle, const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
