#pragma once

// What of a layer is material: overlapping bodies united, crossing contours made right.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>
#include <span>
#include <string_view>

LAMELLA_API_BEGIN
namespace lamella {

/// Where material is, by the winding number w: how many times the layer's rings run counter-clockwise around
/// a place.
enum class FillRule {
    none,     ///< rings stay as they are
    nonzero,  ///< w is not 0: overlapping bodies are united, bodies turned inside out are turned back
    evenodd,  ///< w is odd: what lies in two bodies is empty
    positive, ///< w is above 0: overlapping bodies are united, bodies turned inside out are dropped
};

/// The rule's name as users meet it, such as "nonzero".
[[nodiscard]] std::string_view fill_rule_name(FillRule rule) noexcept;

struct Filled {
    Layer layer; ///< in normal form when the given one was
    /// Groups of rings that overlap and had to be united, and the rings in them. All others keep their
    /// points, bit for bit.
    std::uint64_t groups_united = 0;
    std::uint64_t rings_united = 0;
    std::uint64_t rings_dropped = 0;  ///< others: no boundaries of material
    std::uint64_t rings_reversed = 0; ///< others: the material is on their other side

    [[nodiscard]] bool changed() const noexcept { return groups_united + rings_dropped + rings_reversed > 0; }
};

/// The boundary of the material: rings that do not cross, with material on their left and none on their
/// right.
///
/// Rings that are that already are left alone, also where they touch. Rings that lie within others without
/// touching them are kept, dropped or reversed as they are. Only groups of rings that cross, or touch and
/// overlap, are united on a grid of integers whose unit is at most 2^-36 of the layer's extent (1.5e-9 mm for
/// a layer of 100 mm): their corners keep their coordinates, the points where they cross are off by about a
/// unit. Overlaps of the size of rounding errors count as touching, and of what is united, rings thinner than
/// a unit are left out. Doing it again changes nothing, unless rings of the given layer were as thin as that.
///
/// Open chains stay as they are. Flat rings, which bound nothing, are dropped.
///
/// Expected O(n) to find that a layer is clean, O(n log n) to find what overlaps; to unite rings of m points
/// with k crossings, O((m + k) log m). Throws Error{limit} for a layer of more than 2^32 - 2 points and for
/// more crossings than `limits.memory` has room for, and Error{cancelled}.
[[nodiscard]] Filled fill(const Layer& layer, FillRule rule, const LayerLimits& limits = {});

/// Whether the winding number of all parts together is known to be 0 or 1 everywhere: the boxes of the parts
/// lie apart, and in each no rings touch, counter-clockwise ones lie in nothing, clockwise ones in one body.
/// Open chains do not count. False also for parts that only touch, and for those too large to say. Takes as
/// long as fill() takes to find that a layer is clean; O(b^2) more for b parts whose boxes share abscissae.
[[nodiscard]] bool winds_once(std::span<const Layer> parts);

} // namespace lamella
LAMELLA_API_END
