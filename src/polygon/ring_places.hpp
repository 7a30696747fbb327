#pragma once

// Whether the rings of a layer run the way round that their places among the others ask for.

#include "lamella/contour/layer.hpp"

#include <vector>

namespace lamella {

enum class RingPlace {
    sound,
    overlapping, ///< counter-clockwise, within the material of other rings
    misoriented, ///< leaves a side that is wound round less than no times: clockwise and not within material,
                 ///< or within such a ring
};

/// The place of each ring of the layer, by the winding number of the layer on both sides of the ring. That
/// number is taken at the lowest of the ring's edges at its left end, exactly. It rises by one from right to
/// left of an edge. Material is where it is 1 or more, so a sound layer has 0 and 1 only, overlapping bodies
/// make it 2 and more, and less than 0 means that rings run the wrong way round.
///
/// A hole that runs counter-clockwise is the same thing as a body within another one: overlapping. Where
/// rings share an edge there is no saying in which order they lie, and the order that speaks for them is
/// taken. Rings without width are sound; open chains do not count.
///
/// O(n log c) for n points and c rings, in practice little more than reading the points; where edges cross,
/// up to O(c) more for each of those.
[[nodiscard]] std::vector<RingPlace> ring_places(const Layer& layer);

} // namespace lamella
