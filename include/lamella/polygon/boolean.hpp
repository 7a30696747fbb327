#pragma once

// Boolean operations on the material of two layers: union, intersection, (symmetric) difference.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// Defines the material of the result.
enum class BooleanOperation : std::uint8_t {
    unite,     ///< in either layer
    intersect, ///< in both layers
    subtract,  ///< in the first layer and not in the second
    exclude,   ///< in exactly one of the layers
};

/// Returns the boundary of the material that results from the operation: rings that do not cross, with
/// material on their left and none on their right. A layer has material where its winding number is above 0,
/// as for `offset` and `nesting`: overlapping bodies count once, inverted bodies are ignored (`fill` with
/// FillRule::nonzero reverses them).
///
/// Each ring is kept, dropped or reversed by an exact decision, as in `fill`. Rings without contacts keep
/// their points bit for bit. Rings that only touch keep them, too, unless a ring of one layer runs along a
/// ring of the other. Only groups of rings that cross, or touch and overlap, are rounded to a grid, whose
/// unit is at most 2^-36 of the extent of both layers. The union or intersection of a layer without overlaps
/// with itself is the layer, bit for bit; the difference is empty.
///
/// Index, heights and open chains are those of the first layer. Open chains of the second layer and hatches
/// of both are left out. The result is in normal form. Its rings depend on the order of the layers only for
/// BooleanOperation::subtract.
///
/// Throws Error{limit} for layers of more than 2^32 - 2 points together. O(n) for n points in rings that are,
/// bit for bit, in both layers. For other rings expected O(n + c log c) for n points in c rings, and then the
/// cost of `fill`. Common rings cost the same as other rings if other rings come near them, or if overlaps
/// among them matter (`unite`, `intersect`).
[[nodiscard]] Layer combine(const Layer& first, const Layer& second, BooleanOperation operation,
                            const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
