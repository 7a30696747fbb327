#pragma once

// Steps of the comparison of two stacks of layers, for callers whose layers are not all in memory.

#include "lamella/contour/layer.hpp"
#include "lamella/contour/rounding.hpp"
#include "lamella/polygon/compare.hpp"

#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// Planes in ascending z; their contours are not used.
struct StackPlanes {
    std::span<const Layer> planes;
    Rounding rounding;
    std::vector<bool> drawn; ///< of each plane: whether it has anything to compare
};

/// Throws Error{usage} for a tolerance that is negative or NaN.
void check_tolerance(std::optional<double> tolerance_mm);

/// Pairs the planes of two stacks as `compare` does. Layers are not compared yet. O(planes).
[[nodiscard]] std::vector<ComparedPlane> paired(const StackPlanes& first, const StackPlanes& second,
                                                std::optional<double> tolerance_mm);

/// Compares the layers of a plane: sets `difference` and `agree`. A layer is used only if the plane has its
/// index.
void compare_layers(ComparedPlane& plane, const Layer& first, const Layer& second, double tolerance_mm);

/// Returns StackComparison::cut_apart for the pairs of these stacks.
[[nodiscard]] bool are_cut_apart(const StackPlanes& first, const StackPlanes& second,
                                 std::span<const ComparedPlane> pairs);

} // namespace lamella
