#pragma once

// Finds contours of a layer that cross one another or themselves.

#include "lamella/contour/layer.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Segment `segment_a` of contour `contour_a` (from the point with this index to the next) crosses segment
/// `segment_b` of `contour_b` at approximately `at`.
struct Crossing {
    std::uint64_t contour_a = 0;
    std::uint64_t segment_a = 0;
    std::uint64_t contour_b = 0;
    std::uint64_t segment_b = 0;
    Point2 at;
};

struct Crossings {
    std::uint64_t count = 0;     ///< all of them, or at least the `enough` that were requested
    std::vector<Crossing> first; ///< the first few, ordered by (contour_a, segment_a, contour_b, segment_b)
};

/// Counts pairs of segments that cross properly: each has its ends strictly on both sides of the other.
/// Contours that touch at a point or along a segment do not cross, nor do contours that change sides at a
/// vertex. The decision is exact, on the points as they are. `keep` bounds Crossings::first.
///
/// Throws Error{limit} for a layer of more than 2^32 - 1 points. Expected O(n + crossings); O(n log n) for
/// adverse layers without crossings, O((n + crossings) log n) for long lines that cross their neighbours,
/// parallel or fanning out. In the worst case, long lines in no order that nearly cross, about O(n^1.5 +
/// crossings).
///
/// The search ends after `enough` crossings: then `count` is `enough` or a little more, and `first` are some
/// of them, the same in every call.
[[nodiscard]] Crossings find_crossings(const Layer& layer, std::size_t keep = 16,
                                       std::uint64_t enough = std::numeric_limits<std::uint64_t>::max());

/// Returns whether there are crossings; stops at the first one found.
[[nodiscard]] bool has_crossings(const Layer& layer);

} // namespace lamella
LAMELLA_API_END
