#pragma once

// Offsets with mitred corners by libraries of others, in their own ways. All give the area of a layer moved
// by a distance, with the limit of mitres that is ours by default where they have one.

#include <lamella/lamella.hpp>

namespace lamella::bench {

/// Of layers with nothing to unite before they are moved, on Clipper's grid of integers.
[[nodiscard]] double area_by_clipper(const Layer& layer, double distance);

/// By the buffer of GEOS, of the layer as one multipolygon.
[[nodiscard]] double area_by_geos(const Layer& layer, double distance);

/// By CGAL's straight skeletons, body by body; what bodies that meet have in common counts twice. Takes time
/// that grows with the square of the points.
[[nodiscard]] double area_by_cgal(const Layer& layer, double distance);

} // namespace lamella::bench
