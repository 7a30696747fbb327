#pragma once

// Selects rings of a layer.

#include "lamella/contour/layer.hpp"

LAMELLA_API_BEGIN
namespace lamella {

/// Removes the rings whose area is below `mm2`, bodies and holes alike. Rings within a removed ring are
/// smaller and therefore removed, too. Open chains stay. Throws Error{usage} for an area that is negative or
/// NaN. O(n).
[[nodiscard]] Layer without_small_rings(const Layer& layer, double mm2);

/// Returns the layer reduced to the outer ring of largest area and its holes. All other rings are dropped,
/// also bodies within those holes. Of equally large rings, the first in normal form is kept. Open chains
/// stay. O(n log c) for n points in c rings.
[[nodiscard]] Layer largest_body(const Layer& layer);

} // namespace lamella
LAMELLA_API_END
