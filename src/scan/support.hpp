#pragma once

// Treats supports as parts without skins.

#include "lamella/scan/strategy.hpp"

#include <algorithm>
#include <cstdint>

namespace lamella {

/// Returns a strategy without skins whose core follows the rule for supports.
[[nodiscard]] inline ScanStrategy without_skins(const SupportRule& support, std::uint64_t seed) {
    ScanStrategy strategy;
    strategy.contours = support.contours;
    strategy.hatch = support.hatch;
    strategy.seed = seed;
    return strategy;
}

/// Returns the same strategy with a spot of the hatch that lets lines reach their whole distance. Supports
/// need not be dense.
[[nodiscard]] inline ScanStrategy filling_supports(const SupportRule& support, std::uint64_t seed) {
    ScanStrategy strategy = without_skins(support, seed);
    double& spot = strategy.hatch.parameters.spot_mm;
    spot = std::max(spot, strategy.hatch.distance);
    return strategy;
}

} // namespace lamella
