#pragma once

// Contours of a layer that cross one another or themselves.

#include "lamella/contour/layer.hpp"

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

LAMELLA_API_BEGIN
namespace lamella {

/// Segment `segment_a` of contour `contour_a` (from its point of that number to the next) crosses segment
/// `segment_b` of `contour_b` at about `at`.
struct Crossing {
    std::uint64_t contour_a = 0;
    std::uint64_t segment_a = 0;
    std::uint64_t contour_b = 0;
    std::uint64_t segment_b = 0;
    Point2 at;
};

struct Crossings {
    std::uint64_t count = 0;     ///< all of them, unless there are more than was asked for
    std::vector<Crossing> first; ///< the first few, ordered by (contour_a, segment_a, contour_b, segment_b)
};

/// Counts pairs of segments that cross properly: each has its ends strictly on both sides of the other.
/// Contours that touch in a point or along a piece do not cross, and neither do those that change sides in a
/// vertex. Decided exactly, on the points as they are. `keep` bounds Crossings::first.
///
/// Expected O(n + crossings); O(n log n) for hostile layers without crossings, O((n + crossings) log n) for
/// long lines that cross those beside them, parallel or fanning out. At worst, for long lines in no order
/// that all but cross, about O(n^1.5 + crossings). Throws Error{limit} for a layer of more than 2^32 - 1
/// points.
///
/// The search ends once it has found `enough` crossings: then `count` is that or a few more, and `first` are
/// some of them, the same ones each time.
[[nodiscard]] Crossings find_crossings(const Layer& layer, std::size_t keep = 16,
                                       std::uint64_t enough = std::numeric_limits<std::uint64_t>::max());

/// Whether there are any: stops at the first one found.
[[nodiscard]] bool has_crossings(const Layer& layer);

} // namespace lamella
LAMELLA_API_END
