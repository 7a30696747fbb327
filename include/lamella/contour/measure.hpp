#pragma once

// Areas and lengths of contours.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"

#include <cstddef>
#include <span>

LAMELLA_API_BEGIN
namespace lamella {

/// Returns the signed area in mm^2: positive for a counter-clockwise ring. Coordinates are taken relative to
/// the ring's first point, so that a ring far from the origin loses no precision. O(n).
[[nodiscard]] double ring_area(std::span<const Point2> ring) noexcept;

/// Returns the area up to which a ring is so thin that `rounding` of its points, or the rounding of double
/// precision, may have reversed its orientation: its length times the distance by which a point may have
/// moved. O(n).
[[nodiscard]] double area_of_lost_orientation(std::span<const Point2> ring,
                                              const Rounding& rounding) noexcept;

/// Returns whether a ring is so thin that `rounding` of its points, or the rounding of double precision, may
/// have reversed its orientation. O(n).
[[nodiscard]] bool orientation_is_lost(std::span<const Point2> ring, const Rounding& rounding) noexcept;

/// Returns the length in mm; for a ring it includes the segment back to the first point.
[[nodiscard]] double contour_length(std::span<const Point2> contour, bool closed) noexcept;

struct LayerMeasure {
    std::size_t contours = 0; ///< rings and chains
    std::size_t holes = 0;    ///< clockwise rings
    std::size_t open_chains = 0;
    std::size_t points = 0;
    double area_mm2 = 0; ///< of the rings, holes subtracted
    double perimeter_mm = 0;

    /// Adds the values of another layer.
    void add(const LayerMeasure& other) noexcept;
};

/// Measures all contours of a layer. O(points).
[[nodiscard]] LayerMeasure measure(const Layer& layer) noexcept;

} // namespace lamella
LAMELLA_API_END
