#pragma once

// Finds clockwise rings outside of material. Such rings cannot be holes; the area that they enclose is not
// built.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstdint>

LAMELLA_API_BEGIN
namespace lamella {

/// Areas of a layer with a winding number below 0: inside of inverted bodies, and in the clockwise half of a
/// ring that crosses itself. These areas have no material, since material is where the winding number is
/// above 0.
struct InvertedRings {
    std::uint64_t rings = 0; ///< number of rings that bound these areas
    double area_mm2 = 0;     ///< area of these areas
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
    /// May miss areas that only a search for crossings can find. May also miss a clockwise ring close to the
    /// edge of a hole of more than 64 points, because the box of such a hole is estimated from 16 points.
    quick,
    full,
};

/// Returns the inverted rings of a layer in normal form. A ring does not count if it is so thin that
/// `rounding`, or the single precision in which most meshes are stored, may have inverted it: see
/// `orientation_is_lost`. Rings that cancel each other do not count either: there is no area between them, or
/// a film as thin as this rounding, as where a plane touches a knife edge. All other decisions of a full
/// search are exact, also for rings that touch and overlap.
///
/// Throws the errors of `fill`. A quick search costs O(rings) if all rings run counter-clockwise, and O(n + c
/// log c) if all c clockwise rings lie in material, for outer rings of n points. All other layers, and every
/// full search, cost as much as `fill`.
[[nodiscard]] InvertedRings inverted_rings(const Layer& layer, const Rounding& rounding = {},
                                           InversionSearch search = InversionSearch::quick,
                                           const LayerLimits& limits = {});

} // namespace lamella
LAMELLA_API_END
