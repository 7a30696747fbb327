#pragma once

// Fills an area with lines in scanning order.

#include "lamella/contour/layer.hpp"
#include "lamella/core/unit_circle.hpp"
#include "lamella/scan/strategy.hpp"

#include "core/layer_budget.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// The area to fill. All its layers must consist of rings that bound material and do not cross. They are
/// combined along each line, without operations on polygons.
struct HatchArea {
    // NOLINTNEXTLINE(google-explicit-constructor): most areas are a single layer
    HatchArea(const Layer& all) : within(all) {}

    const Layer& within;
    const Layer* also_within = nullptr;     ///< a further layer to intersect with, or null
    std::vector<const Layer*> without = {}; ///< layers to subtract
};

/// Returns the directions of the lines of a layer: two for squares, three for hexagons, one for other
/// patterns. For each direction, line k lies at v = (k + `line_phase`) * distance in its LineFrame.
[[nodiscard]] std::vector<CosSin> line_angles(const HatchRule& rule, std::uint64_t layer);
/// Returns the phase of the lines. Squares begin half a distance before their first line, so that squares
/// whose size is an integer multiple of the distance meet without a gap and without an overlap.
[[nodiscard]] double line_phase(HatchPattern pattern) noexcept;

/// Returns the hatch lines, two points each, as in Plane::hatches. The index of `within` defines the
/// rotation of the lines and, with the seed, the order of islands. Throws the errors of HatchLines, and
/// Error{limit} for more than 2^28 stripes or islands in a row, 2^22 pieces of lines or 2^21 islands, or more
/// pieces or islands than the budget allows.
[[nodiscard]] PointArray hatch(const HatchArea& area, const HatchRule& rule, std::uint64_t seed,
                               const LayerBudget& budget = {});

/// Returns the width from which on material is hatched for any position of the lines.
[[nodiscard]] double surely_hatched(const HatchRule& rule) noexcept;

} // namespace lamella
