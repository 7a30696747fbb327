#pragma once

// Finds the nesting of the rings of a layer and the bodies that they bound.

#include "lamella/contour/layer.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The kind of a ring, by its direction and by the winding number w just outside of it: the number of times
/// that the layer's rings run counter-clockwise around a point. Material is where w is 1 or more.
enum class RingKind : std::uint8_t {
    outer,       ///< counter-clockwise, w = 0: a body
    hole,        ///< clockwise, w >= 1
    overlapping, ///< counter-clockwise, w >= 1: a body within material, or a hole with the wrong direction
    misoriented, ///< clockwise outside of material, or within such a ring: w is below 0 on one of its sides
    flat,        ///< without area: all of its points are collinear
};

/// The nesting of a layer's rings, ring by ring. Open chains are ignored.
struct Nesting {
    /// Means no ring.
    static constexpr std::uint32_t none = 0xffffffff;

    std::vector<RingKind> kind;
    /// The innermost ring around it, `none` for an outermost one.
    std::vector<std::uint32_t> parent;
    /// Number of rings around it.
    std::vector<std::uint32_t> depth;
    /// w just outside of its left end.
    std::vector<std::int32_t> winding;
    /// w just inside of it: one more for a counter-clockwise ring, one less for a clockwise one.
    std::vector<std::int32_t> winding_inside;
    /// The ring that bounds the same body from outside. For an outer or overlapping ring, the ring itself.
    /// For a hole, the ring whose material it removes: the innermost one around it that is not matched by
    /// another hole between them. `none` for the other kinds.
    std::vector<std::uint32_t> body;
    /// The rings from left to right by their left ends, at the same x from below, at the same point from
    /// outside in: every ring comes after its parent. Rings without points come first.
    std::vector<std::uint32_t> order;

    [[nodiscard]] std::size_t rings() const noexcept { return kind.size(); }
};

/// Finds the nesting of the rings of any layer, in normal form or not.
///
/// Correct and exact for rings that do not cross, also if they touch at points or share edges, with each
/// other or with themselves. Rings that share edges on the same side are nested by their areas. Rings that
/// bound the same area are nested with bodies and holes alternating as far as possible, then by their
/// indices. A flat ring contains nothing.
///
/// If rings cross, `winding` and `kind` are those of the ring's left end, exactly; `parent` is the first ring
/// straight down from the left end that contains it.
///
/// Throws Error{limit} for a layer of more than 2^32 - 2 rings, and for a layer that would take long because
/// its rings cross more than 4 million times plus 64 times the number of their sides. O(n log c) for n points
/// in c rings, in practice little more than reading the points; up to O(c) more for each edge that crosses
/// others.
[[nodiscard]] Nesting nesting(const Layer& layer);

/// A connected area of material, as GeoJSON, 3MF and polygon libraries define it.
struct Polygon {
    std::uint32_t outer = 0; ///< index of the ring
    std::vector<std::uint32_t> holes;
};

/// Returns one polygon for each outer or overlapping ring, with its holes, both in ascending order of their
/// indices. Together they cover each point as often as the layer's rings wind around it. Misoriented and flat
/// rings bound no material and are left out. O(rings).
[[nodiscard]] std::vector<Polygon> polygons(const Nesting& nesting);

} // namespace lamella
LAMELLA_API_END
