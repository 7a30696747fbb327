#pragma once

// Mitred offsets by other libraries. All functions return the area of a layer offset by a distance; libraries
// with a mitre limit use Lamella's default.

#include <lamella/formats.hpp>

namespace lamella::bench {

/// Uses Clipper and its integer grid; the layer must have nothing to unite before.
[[nodiscard]] double area_by_clipper(const Layer& layer, double distance);

/// Uses the buffer of GEOS, with the layer as one multipolygon.
[[nodiscard]] double area_by_geos(const Layer& layer, double distance);

/// Uses CGAL's straight skeletons, body by body; overlaps of the offset bodies count twice. Time grows with
/// the square of the number of points.
[[nodiscard]] double area_by_cgal(const Layer& layer, double distance);

} // namespace lamella::bench
