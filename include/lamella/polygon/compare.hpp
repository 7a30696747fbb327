#pragma once

// How far layers, and stacks of them, are from being the same.

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
    /// The same contours, bit for bit: all that follows is 0 but for the measures.
    bool same = false;
    /// The largest way from a point of one layer's contours to the nearest contour of the other (Hausdorff
    /// distance), to a thousandth, and where it begins. Infinite where one layer has contours and the other
    /// has none.
    double distance_mm = 0;
    Point2 where = {};
    LayerMeasure first = {}; ///< of both layers
    LayerMeasure second = {};
    /// How much area would have to move from end to end of both layers for such different centres.
    double displaced_mm2 = 0;

    /// No point is further away than the tolerance, there are as many open chains, and areas and their
    /// centres differ by no more than contours moved by it explain: by these, rings are told that run the
    /// other way round.
    [[nodiscard]] bool within(double tolerance_mm) const noexcept;
};

/// Expected O(n log n) for n points in both layers; O(n) where they are the same.
[[nodiscard]] LayerDifference compare(const Layer& first, const Layer& second);

/// Layers in ascending z, and how the file that they come from rounds.
struct RoundedLayers {
    std::span<const Layer> layers;
    Rounding rounding = {};
};

/// Two layers that belong together, or one that the other stack has no partner for.
struct ComparedPlane {
    double z = 0; ///< of the cut
    /// Their numbers in the stacks; none where that stack has neither contours nor hatch lines there.
    std::optional<std::size_t> first;
    std::optional<std::size_t> second;
    /// Where there is only one of them, it has its measure alone.
    LayerDifference difference = {};
    bool agree = false;
};

struct StackComparison {
    double tolerance_mm = 0;
    std::vector<ComparedPlane> planes; ///< in ascending z
    /// No layers belong together, though the lowest ones of both lie between the same heights: they were cut
    /// elsewhere between these, or are read as if they were from a format that does not keep the cut.
    bool cut_apart = false;
};

/// Compares two stacks plane by plane. Layers belong together when their cuts are no further apart than the
/// rounding of both formats explains, and beyond that 1e-6 mm, or `tolerance_mm` if that is more; and neither
/// is nearer to another layer. One without contours and hatch lines needs no partner. Hatch lines and heights
/// of layers that belong together do not count: see `compare_files`. `tolerance_mm` is for
/// LayerDifference::within; unless given, it is what the rounding of both formats explains. Distances of
/// layers that are below it are those of corners. Parallel over planes; as expensive as `compare` of all
/// layers that belong together. Throws Error{usage} for a tolerance that is negative or NaN.
[[nodiscard]] StackComparison compare(const RoundedLayers& first, const RoundedLayers& second,
                                      std::optional<double> tolerance_mm = {},
                                      const Execution& execution = {});

} // namespace lamella
LAMELLA_API_END
