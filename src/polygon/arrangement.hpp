#pragma once

// Rings cut where they meet, and the winding number on both sides of every piece.

#include "lamella/contour/layer.hpp"
#include "lamella/polygon/fill.hpp"

#include "polygon/clipping_grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace lamella {

/// The boundary of where w + `around` fulfils the rule, w being the winding number of the rings: bodies
/// counter-clockwise, holes clockwise, rings that meet in a point joined so that each keeps its own wedge of
/// material. Points that were corners of the rings keep their coordinates, others lie on the grid. Rings in
/// any order, each starting anywhere; they do not cross.
///
/// O((n + k) log n) for n points with k crossings, as far as crossings are found in that.
[[nodiscard]] std::vector<Ring> filled(std::span<const std::span<const Point2>> rings, FillRule rule,
                                       std::int64_t around, const ClippingGrid& grid);

/// Whether w + `around` is 0 or 1 everywhere, up to areas that rounding to the grid can make.
[[nodiscard]] bool winds_once(std::span<const std::span<const Point2>> rings, std::int64_t around,
                              const ClippingGrid& grid);

/// Whether the rule makes material of a winding number.
[[nodiscard]] bool is_material(FillRule rule, std::int64_t winding) noexcept;

/// A layer of rings only, not in normal form.
[[nodiscard]] Layer layer_of(std::span<const std::span<const Point2>> rings);

} // namespace lamella
