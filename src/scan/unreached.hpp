#pragma once

// Material that no vector reaches: narrow areas, and the unreached part of them.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/scan/strategy.hpp"

#include "core/layer_budget.hpp"

#include <span>
#include <vector>

namespace lamella {

/// Returns the material that growing its inset by `by` mm does not reach: where it is narrower than twice
/// that. `inset` is the result of `offset`. Returns an empty layer if the area is negligible; this is found
/// without boolean operations, in O(points).
[[nodiscard]] Layer narrow_points(const Layer& material, const Layer& inset, double by,
                                  const LayerLimits& limits = {});

/// Returns the same for contours and a hatch together, for material whose outline lies `depth` inside of the
/// part's outline; also areas narrower than `surely_hatched`.
[[nodiscard]] Layer narrow_points(const Layer& material, double depth, const ContourRule& contours,
                                  const HatchRule& hatch);

/// Returns the distance from contours, and from lines along the middle of walls, within which material counts
/// as reached. For the lines of a hatch it is their distance.
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
/// reach apart. Exact if nothing or everything is reached. O(points + lines), plus for each stroke the lines
/// close to it.
[[nodiscard]] double unreached_area(const Layer& positions, std::span<const Stroke> strokes,
                                    const LayerBudget& budget = {});

/// Returns the bodies, with their holes, of which strokes leave more bare than a 32nd of the square of the
/// shortest reach; in normal form. Costs as much as `unreached_area`, plus for each body a pass over the
/// strokes close to any.
[[nodiscard]] Layer bare_points(const Layer& positions, std::span<const Stroke> strokes,
                                const LayerBudget& budget = {});

} // namespace lamella
