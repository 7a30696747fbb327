#pragma once

// One plane of a plate and its neighbours become scan vectors.

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

/// The layers of all parts on a plane, and on those beneath it and on top, the nearest one first.
struct PlaneLayers {
    std::uint32_t plane = 0; ///< its number among those that are scanned
    std::span<const ScanLayer> parts = {};
    std::vector<std::span<const ScanLayer>> below = {};
    std::vector<std::span<const ScanLayer>> above = {};
};

struct PlaneVectors {
    std::vector<Layer> layers;        ///< of each part each exposure
    std::vector<ScanFigures> figures; ///< of each of `plane_exposures`
    /// Area of each part that no vector reaches; 0 where the strategy accepts it.
    std::vector<double> unreached_mm2;
    std::vector<InvertedRings> inverted; ///< of each part, which have no vectors either
    std::uint64_t hash = 0;              ///< of `layers`, in their order: see content_hash
};

/// What has figures: the exposures of parts, and then those of supports, where there are such; of no part:
/// of all of them. `supports`: for each part whether it is one.
[[nodiscard]] std::vector<Exposure> plane_exposures(const std::vector<bool>& supports,
                                                    const ScanStrategy& strategy);

/// See `scan`. The beam goes through the parts one after the other. `memories`: of each part; `names`: of the
/// parts, for errors, or empty texts. `limits`: for all of them.
[[nodiscard]] PlaneVectors scan_plane(const PlaneLayers& plane, const std::vector<bool>& supports,
                                      std::span<const std::string> names, const ScanStrategy& strategy,
                                      std::vector<InsetCache>& memories, const LayerLimits& limits);

} // namespace lamella
