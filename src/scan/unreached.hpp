#pragma once

// Measures the material that no vector reaches, and finds narrow material, where alone there can be any.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/core/unit_circle.hpp"
#include "lamella/scan/strategy.hpp"

#include "core/layer_budget.hpp"

#include <array>
#include <functional>
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
    [[nodiscard]] Reached near(const Layer& positions) const;
};

/// The rules by which the vectors of a strategy fill material, as far as they define what is narrow.
struct FillDepths {
    /// For supports, see `filling_supports`.
    explicit FillDepths(const ScanStrategy& strategy);

    double filled = 0;     ///< depth from which on all hatches fill the material
    double half_width = 0; ///< half of the width from which on material is hatched for any position of lines
    double least_reach = 0;
    /// Largest unreached spot that does not count within material that is wide enough for the hatch: the tip
    /// of a corner, in which lines are too short.
    double tip_mm2 = 0;
    /// True if the vectors of the strategy reach everything, except in narrow material.
    bool dense = true;
};

/// Returns the inset grown by `by` mm, with its corners up to `reached_mitre`.
[[nodiscard]] Layer grown_to_corners(const Layer& inset, double by, const LayerLimits& limits = {});

/// Returns the part of the material that is wide enough to be hatched for any position of the lines. The
/// outline of the material lies `depth` inside of that of the part.
[[nodiscard]] Layer wide_points(const Layer& material, double depth, const FillDepths& depths,
                                const LayerLimits& limits = {});

/// The bodies of a layer that may have material narrower than a width, or corners below 30 degrees, and the
/// other bodies.
struct BodiesByWidth {
    Layer narrow;
    Layer wide;
};

/// Finds the bodies that are wider than twice `by`: each of their rings is in the inset with its sides moved,
/// but for sides of rounded corners. `inset` is the result of `offset`. O(points), plus the nesting of rings
/// if there are narrow bodies.
[[nodiscard]] BodiesByWidth bodies_by_width(const Layer& material, const Layer& inset, double by);

/// Returns the part of an inset of all bodies that belongs to the narrow ones. `by` is at most the distance
/// by which they were found. O(points).
[[nodiscard]] Layer inset_of_narrow(const BodiesByWidth& bodies, const Layer& inset, double by,
                                    const LayerLimits& limits = {});

/// Returns the part of the material that is not in the inset grown by `by` mm.
[[nodiscard]] Layer narrow_points(const Layer& material, const Layer& inset, double by,
                                  const LayerLimits& limits = {});

/// The parallel lines along which areas are measured: at multiples of a distance from the origin. The angle
/// is oblique to most sides and vectors, because strips along the lines would be measured badly.
struct MeasuringLines {
    MeasuringLines(const Layer& material, const Reached& reached, double least_reach);

    CosSin angle;
    double distance;
};

/// Material that is wide enough for the hatch, where small unreached spots do not count.
struct WideMaterial {
    std::function<Layer()> points =
        {};                  ///< called only if more than `accepted_mm2` is unreached; may be empty
    double tip_mm2 = 0;      ///< largest spot that does not count
    double accepted_mm2 = 0; ///< largest area that may include spots which do not count
};

/// Returns the area of these rings that nothing reaches, mm^2: their area times the unreached share of the
/// lines across them. So it is exact if nothing or everything is reached. O(points + lines), plus for each
/// vector the lines close to it.
[[nodiscard]] double unreached_area(const Layer& positions, const Reached& reached,
                                    const MeasuringLines& lines, const WideMaterial& wide = {},
                                    const LayerBudget& budget = {});

/// Returns the unreached area for which no line is made: 1/32 of the square of the shortest reach. It is
/// small, since many such areas are not negligible.
[[nodiscard]] constexpr double negligible(double least_reach) noexcept {
    return least_reach * least_reach / 32;
}

/// Returns the bodies with an unreached area that is not negligible. The bodies include their holes; the
/// result is in normal form. Takes the time of `unreached_area`, plus a pass for each body over the vectors
/// close to any body.
[[nodiscard]] Layer bare_points(const Layer& positions, const Reached& reached, const MeasuringLines& lines,
                                double least_reach, const LayerBudget& budget = {});

} // namespace lamella
