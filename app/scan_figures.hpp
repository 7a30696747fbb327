#pragma once

// The figures of scan vectors.

#include "lamella/pipeline/scan_layers.hpp"

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

/// Returns the figures of one layer. `layer` must be in the order of `exposures`.
[[nodiscard]] Json scan_json(std::span<const ExposureResult> exposures, std::span<const ScanFigures> layer);

/// Adds the key `energy_j_mm3`, the volumetric energy density; null if the volume is 0.
[[nodiscard]] Json with_density(Json scan, double volume_mm3);

/// Adds the key `unreached_layers`, the number of layers with more unreached material than the strategy
/// accepts.
[[nodiscard]] Json with_unreached(Json scan, const UnreachedMaterial& unreached);

/// Adds the key `hash`, the hash of the vectors of a layer.
[[nodiscard]] Json with_hash(Json scan, std::uint64_t hash);

/// Returns "1,234,567 vectors, 12.3 m marked, 1.2 m jumped, 1 h 02 min, 45.0 kJ".
[[nodiscard]] std::string scan_text(std::span<const ExposureResult> exposures);

} // namespace lamella::app
