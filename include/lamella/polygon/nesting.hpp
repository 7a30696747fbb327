#pragma once

// Finds the nesting of the rings of a layer and the bodies that they bound.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// The kind of a ring, by its direction and by the winding number w just outside of it. (The winding number
/// of a point is how many times the layer's rings run counter-clockwise around it.) Material is where w is 1
/// or more.
enum class RingKind : std::uint8_t {
    outer,       ///< counter-clockwise, w = 0: a body
    hole,        ///< clockwise, w >= 1
    overlapping, ///< counter-clockwise, w >= 1: a body within material, or a hole with the wrong direction
    misoriented, ///< clockwise outside of material, or within such a ring: w is below 0 on one of its sides
    flat,        ///< without area: all of its points are collinear
};

/// The nesting of a layer's rings, ring by ring. Open chains are ignored.
struct Nesting {
    /// Stands for "no ring".
    static constexpr std::uint32_t none = 0xffffffff;

    std::vector<RingKind> kind;
    /// Index of the innermost ring around the ring; `none` for an outermost ring.
    std::vector<std::uint32_t> parent;
    /// Number of rings around the ring.
    std::vector<std::uint32_t> depth;
    /// w just outside of the ring's left end.
    std::vector<std::int32_t> winding;
    /// w just inside of the ring: `winding` plus one for a counter-clockwise ring, minus one for a clockwise
    /// one.
    std::vector<std::int32_t> winding_inside;
    /// Index of the ring that bounds the same body from outside. For an outer or overlapping ring, this is
    /// the ring itself. For a hole, it is the ring whose material the hole removes: going outwards from the
    /// hole, the first outer or overlapping ring that is not already matched by another hole on the path.
    /// `none` for the other kinds.
    std::vector<std::uint32_t> body;
    /// Indices of the rings, ordered by the x of their left ends, then by y, and at the same point from
    /// outside in. So every ring comes after its parent. Rings without points come first.
    std::vector<std::uint32_t> order;

    [[nodiscard]] std::size_t rings() const noexcept { return kind.size(); }
};

/// Finds the nesting of the rings of any layer, in normal form or not.
///
/// The result is exact for rings that do not cross, even if they touch at points or share edges, with each
/// other or with themselves. Rings that lie on the same side of a shared edge are nested by their areas.
/// Rings that bound the same area are nested so that bodies and holes alternate as far as possible, then by
/// their indices. A flat ring contains nothing.
///
/// If rings cross, `winding` and `kind` are exact for the ring's left end, and `parent` is the first ring
/// straight below the left end that contains it.
///
/// Throws Error{limit} for a layer of more than 2^32 - 2 rings, and for a layer whose rings cross more than 4
/// million times plus 64 times the number of their edges, because it would take too long. O(n log c) for n
/// points in c rings, in practice little more than reading the points; each edge that crosses others can cost
/// O(c) more. The memory limit applies to crossings.
[[nodiscard]] Nesting nesting(const Layer& layer, const LayerLimits& limits = {});

/// A connected area of material, as GeoJSON, 3MF and polygon libraries define it.
struct Polygon {
    std::uint32_t outer = 0; ///< index of the ring
    std::vector<std::uint32_t> holes;
};

/// Returns one polygon for each outer or overlapping ring, with its holes, both in ascending order of their
/// indices. The number of polygons that cover a point is its winding number. Misoriented and flat rings bound
/// no material and are left out. O(rings).
[[nodiscard]] std::vector<Polygon> polygons(const Nesting& nesting);

} // namespace lamella
LAMELLA_API_END
