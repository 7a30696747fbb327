#pragma once

// Finds narrow material, where alone there can be any that no vector reaches.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/scan/strategy.hpp"

namespace lamella {

/// The rules by which the vectors of a strategy fill material, as far as they define what is narrow.
struct FillDepths {
    /// For supports, see `filling_supports`.
    explicit FillDepths(const ScanStrategy& strategy);

    double filled = 0;     ///< depth from which on all hatches fill the material
    double half_width = 0; ///< half of the width from which on material is hatched for any position of lines
    double least_reach = 0;
    /// Largest unreached spot that does not count within material that is wide enough for the hatch: the tip
    /// of a corner, in which lines are too short.
    double tip_mm2 = 0;
    /// True if the vectors of the strategy reach everything, except in narrow material.
    bool dense = true;
};

/// Returns the inset grown by `by` mm, with its corners up to `reached_mitre`.
[[nodiscard]] Layer grown_to_corners(const Layer& inset, double by, const LayerLimits& limits = {});

/// Returns the part of the material that is wide enough to be hatched for any position of the lines. The
/// outline of the material lies `depth` inside of that of the part.
[[nodiscard]] Layer wide_area(const Layer& material, double depth, const FillDepths& depths,
                              const LayerLimits& limits = {});

/// The bodies of a layer that may have material narrower than a width, or corners below 30 degrees, and the
/// other bodies.
struct BodiesByWidth {
    Layer narrow;
    Layer wide;
};

/// Finds the bodies that are wider than twice `by`: each of their rings is in the inset with its sides moved,
/// but for sides of rounded corners. `inset` is the result of `offset`. O(points), plus the nesting of rings
/// if there are narrow bodies.
[[nodiscard]] BodiesByWidth bodies_by_width(const Layer& material, const Layer& inset, double by);

/// Returns the part of an inset of all bodies that belongs to the narrow ones. `by` is at most the distance
/// by which they were found. O(points).
[[nodiscard]] Layer inset_of_narrow(const BodiesByWidth& bodies, const Layer& inset, double by,
                                    const LayerLimits& limits = {});

/// Returns the part of the material that is not in the inset grown by `by` mm.
[[nodiscard]] Layer narrow_area(const Layer& material, const Layer& inset, double by,
                                const LayerLimits& limits = {});

} // namespace lamella
