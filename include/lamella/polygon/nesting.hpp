#pragma once

// Which ring of a layer lies within which, and what each of them bounds.

#include "lamella/contour/layer.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// What a ring is, by its direction and by the winding number w just outside of it: the number of times that
/// the layer's rings run counter-clockwise around a place. Material is where w is 1 or more.
enum class RingKind : std::uint8_t {
    outer,       ///< counter-clockwise, w = 0: a body
    hole,        ///< clockwise, w >= 1
    overlapping, ///< counter-clockwise, w >= 1: a body within material, or a hole that runs the wrong way
                 ///< round
    misoriented, ///< clockwise in nothing, or within such a ring: it leaves a w below 0 on one of its sides
    flat,        ///< without area: all of its points on a line
};

/// The nesting of a layer's rings, ring by ring. Open chains do not count.
struct Nesting {
    /// No ring.
    static constexpr std::uint32_t none = 0xffffffff;

    std::vector<RingKind> kind;
    /// The innermost ring around it, `none` for an outermost one.
    std::vector<std::uint32_t> parent;
    /// How many rings are around it.
    std::vector<std::uint32_t> depth;
    /// w just outside of its left end.
    std::vector<std::int32_t> winding;
    /// w just inside of it: one more for a counter-clockwise ring, one less for a clockwise one.
    std::vector<std::int32_t> winding_inside;
    /// The ring that bounds the same body from outside: itself for an outer or overlapping ring; for a hole
    /// the one whose material it takes away, which is the innermost one around it that no hole between them
    /// takes away already. `none` for the other kinds.
    std::vector<std::uint32_t> body;
    /// The rings from left to right by their left ends, above one another from below, in one place from
    /// outside in: so every ring comes after its parent. Rings without points come first.
    std::vector<std::uint32_t> order;

    [[nodiscard]] std::size_t rings() const noexcept { return kind.size(); }
};

/// The nesting of the layer's rings, for any layer, in normal form or not.
///
/// Right, and decided exactly, for rings that do not cross: also where they touch in points or share edges,
/// each other's or their own. Rings that share edges on the same side lie within one another by their areas.
/// Rings that bound the same place lie within one another, bodies and holes in turn as far as there are, then
/// by their numbers. A flat ring is around nothing.
///
/// Where rings cross, `winding` and `kind` are those of the ring's left end, exactly;
/// `parent`: going straight down from the left end, the first ring that contains
/// that point.
///
/// O(n log c) for n points in c rings, in practice little more than reading the points; where edges cross, up
/// to O(c) more for each of those. Throws Error{limit} for a layer of more than 2^32 - 2 rings, and for one
/// where this would take long because its rings cross more than 4 million times and 64 times for each of
/// their sides.
[[nodiscard]] Nesting nesting(const Layer& layer);

/// A connected piece of material as GeoJSON, 3MF and polygon libraries want it.
struct Polygon {
    std::uint32_t outer = 0; ///< number of the ring
    std::vector<std::uint32_t> holes;
};

/// One polygon for each outer or overlapping ring, with its holes, both in ascending order of their numbers.
/// Together they cover each place as many times as the layer's rings wind around it. Misoriented and flat
/// rings bound no material and are left out. O(rings).
[[nodiscard]] std::vector<Polygon> polygons(const Nesting& nesting);

} // namespace lamella
LAMELLA_API_END
