#pragma once

// Finds narrow areas of material, and measures the part of them that no vector reaches.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/scan/strategy.hpp"

#include "core/layer_budget.hpp"

#include <span>
#include <vector>

namespace lamella {

/// Returns the material that is not reached when its inset is grown by `by` mm, which is the material
/// narrower than twice `by`. `inset` is the result of `offset`. Returns an empty layer if the area is
/// negligible. This is usually found without boolean operations, in O(points).
[[nodiscard]] Layer narrow_points(const Layer& material, const Layer& inset, double by,
                                  const LayerLimits& limits = {});

/// Returns the narrow areas for all contours and the hatch together, including areas narrower than
/// `surely_hatched`. The outline of `material` lies `depth` inside of the outline of the part.
[[nodiscard]] Layer narrow_points(const Layer& material, double depth, const ContourRule& contours,
                                  const HatchRule& hatch);

/// Returns the distance from contours, and from lines along the middle of walls, within which material counts
/// as reached. Lines of a hatch reach as far as their distance.
[[nodiscard]] double contour_reach(const ContourRule& rule) noexcept;

/// A vector and the distance from it within which material is reached.
struct Stroke {
    Point2 from;
    Point2 to;
    double reach = 0;
};

/// Appends the vectors of a layer.
void add_strokes(const Layer& polylines, std::span<const Point2> hatches, double reach,
                 std::vector<Stroke>& strokes);

/// Returns the area of these rings that no stroke reaches, mm^2, measured along lines half of the shortest
/// reach apart. The result is exact if nothing or everything is reached. O(points + lines), plus for each
/// stroke the lines close to it.
[[nodiscard]] double unreached_area(const Layer& positions, std::span<const Stroke> strokes,
                                    const LayerBudget& budget = {});

/// Returns the bodies with an unreached area of more than 1/32 of the square of the shortest reach. The
/// bodies include their holes; the result is in normal form. Takes the time of `unreached_area`, plus a pass
/// for each body over the strokes close to any body.
[[nodiscard]] Layer bare_points(const Layer& positions, std::span<const Stroke> strokes,
                                const LayerBudget& budget = {});

} // namespace lamella
