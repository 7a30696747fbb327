#pragma once

// Measures the differences between layers, and between stacks of layers.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/execution.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

struct LayerDifference {
    /// True if the contours are equal, bit for bit. The distance and `displaced_mm2` are then 0.
    bool same = false;
    /// Hausdorff distance: the largest distance from a point of one layer's contours to the nearest contour
    /// of the other, accurate to a thousandth of itself; `where` is that point. The distance is infinite if
    /// only one layer has contours.
    double distance_mm = 0;
    Point2 where = {};
    LayerMeasure first = {}; ///< measures of both layers
    LayerMeasure second = {};
    /// Difference of the first moments, divided by the extent of both layers. This is the area that would
    /// have to move across the whole extent to cause the difference.
    double displaced_mm2 = 0;

    /// Returns whether no point is farther away than the tolerance, the numbers of open chains are equal, and
    /// areas and centroids differ by no more than moving the contours by the tolerance can cause. Areas and
    /// centroids reveal reversed rings.
    [[nodiscard]] bool within(double tolerance_mm) const noexcept;
};

/// Compares the contours of two layers. Expected O(n log n) for n points in both; O(n) if they are equal.
[[nodiscard]] LayerDifference compare(const Layer& first, const Layer& second);

/// Layers in ascending z, and the rounding of the file that they come from.
struct RoundedLayers {
    std::span<const Layer> layers;
    Rounding rounding = {};
};

/// Two layers that belong together, or one without a partner in the other stack.
struct ComparedPlane {
    double z = 0; ///< height of the cut, mm
    /// Index of the layer in each stack; none if that stack has nothing at this height.
    std::optional<std::size_t> first;
    std::optional<std::size_t> second;
    /// If there is only one layer, only its measure is set.
    LayerDifference difference = {};
    bool agree = false;
};

struct StackComparison {
    double tolerance_mm = 0;
    std::vector<ComparedPlane> planes; ///< in ascending z
    /// True if no layers belong together although the lowest layers of both stacks have the same bottom and
    /// top. Then the stacks were cut at different heights, or one of them comes from a format that does not
    /// store the cut.
    bool cut_apart = false;
};

/// Compares two stacks plane by plane. Two layers belong together if each is the nearest to the other, and if
/// their cuts are no further apart than the rounding errors of both formats plus the larger of 1e-6 mm and
/// `tolerance_mm`. A layer without contours needs no partner. Heights of layers that belong together are not
/// compared; see `compare_files`. `tolerance_mm` is passed to
/// LayerDifference::within; the default is the sum of the rounding errors of both formats. Distances below
/// `tolerance_mm` are measured at corners only. Throws Error{usage} for a tolerance that is negative or NaN.
/// Parallel over planes; costs as much as `compare` of all layers that belong together.
[[nodiscard]] StackComparison compare(const RoundedLayers& first, const RoundedLayers& second,
                                      std::optional<double> tolerance_mm = {},
                                      const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
