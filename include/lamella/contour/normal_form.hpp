#pragma once

// One layer, one sequence of bytes: the normal form, equality and the content hash.

#include "lamella/contour/layer.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

LAMELLA_API_BEGIN
namespace lamella {

/// The normal form of a layer: every ring starts at its lexicographically smallest point (where that point
/// occurs more than once, at the occurrence that makes the whole sequence smallest); closed rings come first
/// and open chains after them; each of the two groups is ordered by first point, then by the whole sequence.
/// Slicing and reading return layers in normal form. O(n + c log c) for n points in c contours, O(n log c)
/// where many contours begin alike. A layer that is in normal form is passed through; its points are shared,
/// not copied.
[[nodiscard]] Layer normal_form(Layer layer);

/// O(n). Stops at the first contour that is out of place.
[[nodiscard]] bool in_normal_form(const Layer& layer) noexcept;

/// The two rules that make the normal form, for code that lays contours out by itself.
///
/// Where the normal form of a ring starts: the first index whose rotation of the ring is smallest. O(n), also
/// for rings that repeat themselves. 0 for an empty ring.
[[nodiscard]] std::size_t smallest_rotation(std::span<const Point2> ring) noexcept;
/// Whether contour `a` stands before `b` in its group, both already rotated. False for equal contours. O(n).
[[nodiscard]] bool stands_before(std::span<const Point2> a, std::span<const Point2> b) noexcept;

/// Same contours, bit for bit. Index, z, bottom and top do not count.
[[nodiscard]] bool same_contours(const Layer& a, const Layer& b) noexcept;

/// A 64-bit hash of the contours of a layer in normal form. It is XXH3 (64 bits, seed 0) over these bytes,
/// all little-endian: the number of contours and the number of rings as 64-bit integers, then for each
/// contour the number of points up to its end as a 64-bit integer (`offsets` without its first element), then
/// x and y of all points as doubles, then those of hatch lines, where there are any. Index, z, bottom and top
/// do not count. So of scan vectors, which are in no normal form, it tells the order. O(n), at the speed of
/// memory.
[[nodiscard]] std::uint64_t content_hash(const Layer& layer) noexcept;

} // namespace lamella
LAMELLA_API_END
