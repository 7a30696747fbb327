#pragma once

// Material that no vector reaches: narrow places, and how much of them is left.

#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/scan/strategy.hpp"

#include "core/layer_budget.hpp"

#include <span>
#include <vector>

namespace lamella {

/// Of some material what is out of reach for its own inset, by `by` mm: where it is narrower than twice that.
/// `inset`: as `offset` made it. Empty where that is next to nothing, which is found out without cutting
/// anything. O(points) then.
[[nodiscard]] Layer narrow_points(const Layer& material, const Layer& inset, double by,
                                  const LayerLimits& limits = {});

/// All of that for contours and a hatch, of material whose outline lies `depth` inside of that of the part.
/// Besides, what is narrower than `surely_hatched`.
[[nodiscard]] Layer narrow_points(const Layer& material, double depth, const ContourRule& contours,
                                  const HatchRule& hatch);

/// How far beside contours, and lines along the middle of walls, material counts as reached; beside the lines
/// of a hatch it is their distance.
[[nodiscard]] double contour_reach(const ContourRule& rule) noexcept;

/// A vector, and how far beside it material is reached.
struct Stroke {
    Point2 from;
    Point2 to;
    double reach = 0;
};

/// Adds the vectors of a layer.
void add_strokes(const Layer& vectors, double reach, std::vector<Stroke>& strokes);

/// The area of these places that no stroke reaches, in mm^2: along lines half of the shortest reach
/// apart; exact where nothing is reached, and where all is. O(points + lines), and for each stroke the lines
/// that it comes near to.
[[nodiscard]] double unreached_area(const Layer& positions, std::span<const Stroke> strokes,
                                    const LayerBudget& budget = {});

/// Those of the places, each a body with its holes, of which strokes leave more bare than a 32nd of the
/// square of the shortest reach; in normal form. Costs as `unreached_area`, and for each body a look at the
/// strokes that come near to any.
[[nodiscard]] Layer bare_points(const Layer& positions, std::span<const Stroke> strokes,
                                const LayerBudget& budget = {});

} // namespace lamella
