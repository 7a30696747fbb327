#pragma once

// Which rings of a layer are wanted.

#include "lamella/contour/layer.hpp"

LAMELLA_API_BEGIN
namespace lamella {

/// The layer without the rings whose area is below `mm2`, bodies and holes alike: what lies within a dropped
/// ring is smaller and goes with it. Open chains stay. O(n). Throws Error{usage} for an area that is negative
/// or NaN.
[[nodiscard]] Layer without_small_rings(const Layer& layer, double mm2);

/// The body with the largest outer ring, and its holes. All other rings are dropped, also bodies that lie
/// within those holes. Of equally large ones it is the first in normal form. Open chains stay. O(n log c) for
/// n points in c rings.
[[nodiscard]] Layer largest_body(const Layer& layer);

} // namespace lamella
LAMELLA_API_END
