#pragma once

// Exposures of a file of scan vectors by part, and the rules of a strategy that apply to them.

#include "lamella/contour/exposure.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/scan/strategy.hpp"

#include <span>
#include <vector>

namespace lamella {

/// Exposures whose vectors fill the same material.
struct ExposureGroup {
    std::vector<const LayerPart*> exposures;
    const LayerPart* outermost = nullptr; ///< of its contours
};

/// Returns the exposures of each part, or a single group of all parts. Parts of the file that are not scan
/// vectors are left out.
[[nodiscard]] std::vector<ExposureGroup> groups_of(std::span<const LayerPart> parts, bool all_together);

[[nodiscard]] const ContourRule& contours_of(const ScanStrategy& strategy, ScanRegion region) noexcept;
[[nodiscard]] const HatchRule& hatch_of(const ScanStrategy& strategy, ScanRegion region) noexcept;

/// Returns the required distance of the vectors of an exposure from the outline of the part.
[[nodiscard]] double depth_of(const Exposure& exposure, const ScanStrategy& strategy) noexcept;
/// Returns the largest distance of the lines of a contour from the outline of the part.
[[nodiscard]] double deepest_line(const Exposure& exposure, const ScanStrategy& strategy) noexcept;

} // namespace lamella
