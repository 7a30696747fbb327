#pragma once

// One layer, one sequence of bytes: the normal form, equality and the content hash.

#include "lamella/contour/layer.hpp"

#include <cstdint>

namespace lamella {

/// The normal form of a layer: every ring starts at its lexicographically smallest point (where that point
/// occurs more than once, at the occurrence that makes the whole sequence smallest); closed rings come first
/// and open chains after them; each of the two groups is ordered by first point, then by the whole sequence.
/// Slicing and reading return layers in normal form. O(n + c log c) for n points in c contours.
[[nodiscard]] Layer normal_form(const Layer& layer);

[[nodiscard]] bool in_normal_form(const Layer& layer);

/// Same contours, bit for bit. Index, z, bottom and top do not count.
[[nodiscard]] bool same_contours(const Layer& a, const Layer& b) noexcept;

/// A 64-bit hash (XXH3) of the contours of a layer in normal form: of each contour's closedness and number of
/// points, then of all points as little-endian doubles. Index, z, bottom and top do not count.
[[nodiscard]] std::uint64_t content_hash(const Layer& layer) noexcept;

} // namespace lamella
