#pragma once

// The figures of scan vectors.

#include "lamella/jobs/file_result.hpp"

#include "figures.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella::app {

/// Returns the totals: contour_vectors, hatch_vectors, marked_mm, jumped_mm, build_seconds, energy_j,
/// unreached_mm2.
[[nodiscard]] Figures scan_figures(std::span<const ExposureResult> exposures);

/// Returns the same figures as an object; if there are several regions, also the figures by region, under the
/// key `regions`.
[[nodiscard]] Json scan_json(std::span<const ExposureResult> exposures);
/// Figures of each region, ordered as in the table of regions: contour_vectors, hatch_vectors, marked_mm.
struct RegionFigures {
    std::string name;
    Json json;
    std::string text;
};
[[nodiscard]] std::vector<RegionFigures> region_figures(std::span<const ExposureResult> exposures);

/// Returns the figures of a job, and also `energy_j_mm3` (the volumetric energy density; null if the volume
/// is 0), `unreached_layers` (the number of layers with more unreached material than the strategy accepts)
/// and the strategy.
[[nodiscard]] Json scan_json(const FileResult& result, const ScanStrategy& strategy);

/// Returns the figures of one layer, and also `energy_j_mm3` and `hash`, the hash of its vectors.
[[nodiscard]] Json scan_json(std::span<const ExposureResult> exposures, const LayerStatistics& layer);

/// Returns "1,234,567 vectors, 12.3 m marked, 1.2 m jumped, 1 h 02 min, 45.0 kJ".
[[nodiscard]] std::string scan_text(std::span<const ExposureResult> exposures);

} // namespace lamella::app
