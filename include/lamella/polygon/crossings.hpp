#pragma once

// Finds contours of a layer that cross one another or themselves.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"

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
    std::uint64_t count = 0;     ///< number of all crossings, or at least `enough` if the search ended early
    std::vector<Crossing> first; ///< the first few, ordered by (contour_a, segment_a, contour_b, segment_b)
};

/// Counts pairs of segments that cross properly: the ends of each lie strictly on opposite sides of the
/// other. Contours that touch at a point or along a segment do not cross in this sense, nor do contours that
/// change sides at a vertex. The decision is exact for the given coordinates. `keep` is the largest size of
/// Crossings::first.
///
/// Throws Error{limit} for a layer of more than 2^32 - 1 points. For k crossings expected O(n + k). Without
/// crossings at most O(n log n); for long lines, parallel or fanning out, that cross their neighbours O((n +
/// k) log n). The worst case, about O(n^1.5 + k), is long lines in all directions that nearly cross.
///
/// The search ends early once it has found `enough` crossings. Then `count` is `enough` or a little more, and
/// `first` contains some of the crossings found, the same ones in every call.
///
/// Stops if `limits` say so; their memory limit does not apply: the caller chooses `keep`.
[[nodiscard]] Crossings find_crossings(const Layer& layer, std::size_t keep = 16,
                                       std::uint64_t enough = std::numeric_limits<std::uint64_t>::max(),
                                       const LayerLimits& limits = {});

/// Returns whether there are crossings; stops at the first one found.
[[nodiscard]] bool has_crossings(const Layer& layer);

} // namespace lamella
LAMELLA_API_END
