#pragma once

// The area that scan vectors reach.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/scan/strategy.hpp"

#include <array>
#include <span>
#include <vector>

namespace lamella {

/// Returns the distance from contours, and from lines along the middle of walls, within which material counts
/// as reached.
[[nodiscard]] double contour_reach(const ContourRule& rule) noexcept;
/// Returns the distance from hatch lines within which material counts as reached.
[[nodiscard]] double hatch_reach(const ContourRule& contours, const HatchRule& rule) noexcept;

/// The corners of material up to this limit of mitres, which is that of 30 degrees, count as reached by the
/// rings around them, although a beam rounds them off.
inline constexpr double reached_mitre = 3.8637;

/// A vector and the distance from it within which material is reached.
struct Stroke {
    Point2 from;
    Point2 to;
    double reach = 0;
};

/// The area that the vectors of a layer reach.
struct Reached {
    std::vector<Stroke> strokes;
    /// The corner pieces that join the strips beside the sides of rings, as `offset` makes them: two ends of
    /// strips, and one or two points between them.
    std::vector<std::array<Point2, 4>> corners;

    /// Appends vectors: rings with their corners, chains, and lines of two points each. Coordinates are
    /// rounded first.
    void add(const Layer& polylines, std::span<const Point2> lines, double reach,
             const Rounding& rounding = {});
    /// Returns what may reach one of these rings, and little else.
    [[nodiscard]] Reached near(const Layer& area) const;
};

} // namespace lamella
