#pragma once

// Computes the material of a layer: unites overlapping bodies and resolves crossing contours.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>
#include <span>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// Defines the material by the winding number w: how many times the layer's rings run counter-clockwise
/// around a point.
enum class FillRule {
    none,     ///< rings stay as they are
    nonzero,  ///< w is not 0: overlapping bodies are united, inverted bodies are reversed
    evenodd,  ///< w is odd: the intersection of two bodies is empty
    positive, ///< w is above 0: overlapping bodies are united, inverted bodies are dropped
};

/// Returns the rule's name in the user interface, such as "nonzero".
[[nodiscard]] std::string_view fill_rule_name(FillRule rule) noexcept;

struct Filled {
    Layer layer; ///< in normal form if the given one was
    /// Number of groups of overlapping rings that were united, and of the rings in them. All other rings keep
    /// their points, bit for bit.
    std::uint64_t groups_united = 0;
    std::uint64_t rings_united = 0;
    std::uint64_t rings_dropped = 0;  ///< other rings that do not bound material
    std::uint64_t rings_reversed = 0; ///< other rings with material on their right

    [[nodiscard]] bool changed() const noexcept { return groups_united + rings_dropped + rings_reversed > 0; }
};

/// Returns the boundary of the material: rings that do not cross, with material on their left and none on
/// their right.
///
/// Rings that already are such a boundary are unchanged, also where they touch. Nested rings without contacts
/// are kept, dropped or reversed, and keep their points bit for bit. Only groups of rings that cross, or
/// touch and overlap, are united. Their crossings are rounded to a grid whose unit is at most 2^-36 of the
/// layer's extent (1.5e-9 mm for a layer of 100 mm), and are accurate to about a unit. Their corners keep
/// their coordinates, unless the new rings would then cross; in this case corners are rounded to the grid,
/// too. Overlaps of the size of rounding errors count as touching, and united rings thinner than a unit are
/// left out. A second call changes nothing, unless rings of the given layer were thinner than a unit.
///
/// Open chains stay as they are. Flat rings, which bound nothing, are dropped.
///
/// Throws Error{limit} for a layer of more than 2^32 - 2 points and for more crossings than `limits.memory`
/// allows, and Error{cancelled}. Expected O(n) if the layer needs no change, O(n log n) to find overlaps, and
/// O((m + k) log m) to unite rings of m points with k crossings.
[[nodiscard]] Filled fill(const Layer& layer, FillRule rule, const LayerLimits& limits = {});

/// Returns whether the winding number of all parts together is known to be 0 or 1 everywhere: the boxes of
/// the parts are disjoint, and within each part no rings touch, counter-clockwise rings lie in no ring, and
/// clockwise rings lie in one body. Open chains are ignored. False also for parts that only touch, and for
/// parts of too many points. Costs as much as the search for overlaps in fill(), plus O(b^2) for b parts
/// whose boxes overlap in x.
[[nodiscard]] bool winds_once(std::span<const Layer> parts);

} // namespace lamella
LAMELLA_API_END
