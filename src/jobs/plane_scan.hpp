#pragma once

// Computes the scan vectors of one plane of a plate from its layers and their neighbours.

#include "lamella/contour/exposure.hpp"
#include "lamella/contour/layer.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/scan/scan.hpp"
#include "lamella/scan/strategy.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lamella {

/// The layers of all parts on a plane, on the planes below it and on the planes above it. The nearest plane
/// is first.
struct PlaneLayers {
    std::uint32_t plane = 0; ///< number of the plane among those that are scanned
    std::span<const ScanLayer> parts = {};
    std::vector<std::span<const ScanLayer>> below = {};
    std::vector<std::span<const ScanLayer>> above = {};
};

struct PlaneVectors {
    Plane vectors;                    ///< of the exposures of each part, part by part
    std::vector<ScanFigures> figures; ///< one for each of `plane_exposures`
    /// Area of each part that no vector reaches; 0 if the strategy accepts it.
    std::vector<double> unreached_mm2;
    std::vector<InvertedRings> inverted; ///< inverted rings of each part, which have no vectors
    std::uint64_t hash = 0;              ///< of `vectors`: see content_hash
};

/// Returns the exposures that have figures: those of ordinary parts, if there are any, then those of
/// supports, if there are any. `supports` is true for each part that is a support.
[[nodiscard]] std::vector<Exposure> plane_exposures(const std::vector<bool>& supports,
                                                    const ScanStrategy& strategy);

/// Computes the scan vectors of all parts on a plane; see `scan`. The beam exposes one part after the other.
/// `caches` and `names` have an entry for each part. Error messages begin with the name, which may be "".
/// `written` is the rounding of the output. `limits` apply to all parts together.
[[nodiscard]] PlaneVectors scan_plane(const PlaneLayers& plane, const std::vector<bool>& supports,
                                      std::span<const std::string> names, const ScanStrategy& strategy,
                                      const Rounding& written, std::vector<InsetCache>& caches,
                                      const LayerLimits& limits);

} // namespace lamella
