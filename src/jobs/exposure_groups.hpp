#pragma once

// Exposures of a file of scan vectors by part, and the rules of a strategy that apply to them.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/plane_source.hpp"
#include "lamella/scan/strategy.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace lamella {

/// Exposures whose vectors fill the same material.
struct ExposureGroup {
    std::vector<std::size_t> exposures;   ///< indices of parts of the file
    std::optional<std::size_t> outermost; ///< of its contours
};

/// Returns the exposures of each part, or a single group of all parts. Parts of the file that are not scan
/// vectors are left out. Reads the planes only if contours of a part are not numbered.
[[nodiscard]] std::vector<ExposureGroup> groups_of(const PlaneSource& file, bool all_together,
                                                   const Execution& execution);

/// The vectors of an exposure on a plane.
struct PlaneExposure {
    const Exposure& exposure;
    const Layer& polylines;
    std::span<const Point2> hatches;
    bool outermost = false; ///< of its group
};

/// The vectors of a group on a plane; at least one exposure.
using PlaneGroup = std::vector<PlaneExposure>;

/// `vectors` are those of the plane of the file; the result refers to them.
[[nodiscard]] PlaneGroup on_plane(const ExposureGroup& group, const PlaneSource& file, const Plane& vectors);

[[nodiscard]] const ContourRule& contours_of(const ScanStrategy& strategy, ScanRegion region) noexcept;
[[nodiscard]] const HatchRule& hatch_of(const ScanStrategy& strategy, ScanRegion region) noexcept;

/// Returns the required distance of the vectors of an exposure from the outline of the part.
[[nodiscard]] double depth_of(const Exposure& exposure, const ScanStrategy& strategy) noexcept;

} // namespace lamella
