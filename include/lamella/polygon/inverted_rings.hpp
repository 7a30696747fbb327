#pragma once

// Rings that run clockwise where there is no material to have a hole in: nothing is made of what they
// enclose.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// Where a layer's winding number is below 0: what bodies turned inside out enclose, and the clockwise half
/// of a ring that crosses itself. Material is where it is above 0, so these places have none.
struct InvertedRings {
    std::uint64_t rings = 0; ///< around these places, and around what they surround
    double area_mm2 = 0;     ///< of these places
    Point2 at;               ///< a point of the first of the rings

    InvertedRings& operator+=(const InvertedRings& other) noexcept {
        if (rings == 0)
            at = other.at;
        rings += other.rings;
        area_mm2 += other.area_mm2;
        return *this;
    }
    friend bool operator==(const InvertedRings&, const InvertedRings&) = default;
};

enum class InversionSearch : std::uint8_t {
    /// May miss what only crossings reveal, and a ring in a hole of more than 64 points, nearer to its edge
    /// than
    /// 16 of these tell.
    quick,
    full,
};

/// The inverted rings of a layer in normal form. Those so thin that `rounding`, or single precision, which
/// most meshes have, may have turned them over do not count: see `orientation_is_lost`. Exact up to that, for
/// rings that touch and overlap, too.
///
/// A quick search costs O(rings) for a layer whose rings all run counter-clockwise. One whose clockwise rings
/// lie in material takes O(n + c log c) for n points in outer rings and c rings, at about the speed of
/// memory. Every other layer, and each of them in a full search, takes as long as `fill`. Throws what `fill`
/// throws.
[[nodiscard]] InvertedRings inverted_rings(const Layer& layer, const Rounding& rounding = {},
                                           InversionSearch search = InversionSearch::quick,
                                           const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
