#pragma once

// How far two layers are from being the same.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/measure.hpp"

namespace lamella {

struct LayerDifference {
    /// The same contours, bit for bit: everything below is 0.
    bool same = false;
    /// The largest way from a corner of one layer to the nearest contour of the other (Hausdorff distance, of
    /// corners), and where it begins. Infinite where one layer has contours and the other has none.
    double distance_mm = 0;
    Point2 where = {};
    LayerMeasure first = {}; ///< of both layers, unless they are the same
    LayerMeasure second = {};

    /// No point is further away than the tolerance, there are as many open chains, and areas differ by no
    /// more than contours moved by it explain: a ring that runs the other way round is told by its area.
    [[nodiscard]] bool within(double tolerance_mm) const noexcept;
};

/// Expected O(n log n) for n points in both layers; O(n) where they are the same.
[[nodiscard]] LayerDifference compare(const Layer& first, const Layer& second);

} // namespace lamella
