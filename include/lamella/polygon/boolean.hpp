#pragma once

// Two layers made into one: union, intersection, difference, exclusive or of their material.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// Where the result has material.
enum class BooleanOperation : std::uint8_t {
    unite,     ///< where either layer has
    intersect, ///< where both have
    subtract,  ///< where the first has and the second has not
    exclude,   ///< where one has and the other has not
};

/// The boundary of the material that the operation makes of that of two layers: rings that do not cross, with
/// material on their left and none on their right. A layer has material where its winding number is above 0,
/// as for `offset` and `nesting`: bodies that overlap count once, bodies turned inside out are none (`fill`
/// by FillRule::nonzero turns them back).
///
/// Decided as `fill` does, exactly, and with the same care for what there is: rings that meet nothing are
/// kept, dropped or reversed as they are, bit for bit, and so are those that only touch, but where a ring of
/// one layer runs along one of the other. Only groups of rings that cross, or touch and overlap, are united
/// on a grid of integers whose unit is at most 2^-36 of the extent of both layers. A layer without overlaps
/// united or intersected with itself stays as it is, bit for bit; what is taken from itself is empty.
///
/// Index, heights and open chains are those of the first layer; open chains of the second, and hatches of
/// both, are left out. The result is in normal form. But for these, the order of the layers only counts for
/// BooleanOperation::subtract.
///
/// O(n) for n points in rings that both layers have, bit for bit; those too count as other rings only where
/// these come near, or where their own overlaps matter (`unite`, `intersect`). Expected O(n) and O(c log c)
/// for c other rings, then as `fill`. Throws Error{limit} for layers of more than 2^32 - 2 points together.
[[nodiscard]] Layer combine(const Layer& first, const Layer& second, BooleanOperation operation,
                            const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
