#pragma once

// Treats supports as parts without skins.

#include "lamella/scan/strategy.hpp"

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

} // namespace lamella
