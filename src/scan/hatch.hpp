#pragma once

// Lines that fill an area, in the order in which a beam follows them.

#include "lamella/contour/layer.hpp"
#include "lamella/core/unit_circle.hpp"
#include "lamella/scan/strategy.hpp"

#include "core/layer_budget.hpp"

#include <cstdint>
#include <vector>

namespace lamella {

/// What is to be filled. All layers are of rings that bound material, none of which cross. What they have in
/// common is decided along each line, so that no polygons have to be cut.
struct HatchArea {
    // NOLINTNEXTLINE(google-explicit-constructor): most areas are a layer
    HatchArea(const Layer& all) : within(all) {}

    const Layer& within;
    const Layer* also_within = nullptr;     ///< if given
    std::vector<const Layer*> without = {}; ///< nothing of these
};

/// Of the lines of a layer: islands have lines in two or three directions. Line k of each lies at v = (k +
/// `line_phase`) * distance in the LineFrame of its angle.
[[nodiscard]] std::vector<CosSin> line_angles(const HatchRule& rule, std::uint64_t layer);
/// Squares begin half a distance before their first line, so that those that are a whole number of lines wide
/// meet without a gap and without an overlap.
[[nodiscard]] double line_phase(HatchPattern pattern) noexcept;

/// Two points each, as Layer::hatches. The index of `within` says how far the lines are turned, and with the
/// seed in which order islands come. Throws what HatchLines throws, and Error{limit} for more than 2^28
/// stripes or islands in a row, 2^22 pieces of lines or 2^21 islands, or more pieces or islands than the
/// budget has room for. `bare`, where given, becomes whether there may be places that are narrower than
/// `surely_hatched` and have no line within its distance: pieces that are too short have no lines, and strips
/// may lie between two. What would be a few squares of half the distance in all does not count.
[[nodiscard]] PointArray hatch(const HatchArea& area, const HatchRule& rule, std::uint64_t seed,
                               bool* bare = nullptr, const LayerBudget& budget = {});

/// How wide material is that has a line wherever lines come to lie.
[[nodiscard]] double surely_hatched(const HatchRule& rule) noexcept;

} // namespace lamella
