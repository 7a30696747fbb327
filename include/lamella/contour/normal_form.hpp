#pragma once

// The normal form of layers, in which equal layers have equal bytes; tests for equality and the content hash.

#include "lamella/contour/layer.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

LAMELLA_API_BEGIN
namespace lamella {

/// Returns the normal form of a layer. Every ring starts at its lexicographically smallest point; if that
/// point occurs more than once, at the occurrence that makes the whole sequence smallest. Closed rings come
/// first, then open chains. Each of the two groups is ordered by first point, then by the whole sequence.
/// Slicing and reading return layers in normal form. A layer in normal form is returned as it is; its points
/// are shared. O(n + c log c) for n points in c contours; O(n log c) if many contours begin alike.
[[nodiscard]] Layer normal_form(Layer layer);

/// Returns whether a layer is in normal form. Stops at the first contour out of order. O(n).
[[nodiscard]] bool in_normal_form(const Layer& layer) noexcept;

/// This function and the next are the rules of the normal form, for code that orders contours by itself.
///
/// Returns the index of the point at which the normal form of a ring starts: the sequence of points from
/// there is lexicographically smallest; the first such index if there are several. 0 for an empty ring. O(n),
/// even for rings that repeat themselves.
[[nodiscard]] std::size_t smallest_rotation(std::span<const Point2> ring) noexcept;
/// Returns whether contour `a` comes before contour `b` in the normal form; false if they are equal. Requires
/// two rings that begin at their smallest_rotation, or two chains. O(n).
[[nodiscard]] bool stands_before(std::span<const Point2> a, std::span<const Point2> b) noexcept;

/// Returns whether the contours are the same, bit for bit. Index, z, bottom and top are ignored.
[[nodiscard]] bool same_contours(const Layer& a, const Layer& b) noexcept;

/// Returns a 64-bit hash of the contours of a layer in normal form: XXH3 (64 bits, seed 0) over the following
/// bytes, all little-endian. First the number of contours and the number of rings as 64-bit integers; then
/// for each contour the number of points up to its end as a 64-bit integer (`offsets` without its first
/// element); then x and y of all points as doubles. Index, z, bottom and top are ignored. O(n), limited by
/// memory bandwidth.
[[nodiscard]] std::uint64_t content_hash(const Layer& layer) noexcept;

} // namespace lamella
LAMELLA_API_END
