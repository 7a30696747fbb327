#pragma once

// The part of a job between its source of layers and its output.

#include "lamella/contour/rounding.hpp"
#include "lamella/core/layer_limits.hpp"
#include "lamella/jobs/plate.hpp"
#include "lamella/jobs/print_check.hpp"
#include "lamella/polygon/layer_steps.hpp"
#include "lamella/scan/strategy.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lamella {

/// The bodies whose layers a source passes on, which are the parts and then the negative volumes, and the
/// stages that these layers go through.
struct LayerJob {
    std::vector<std::string> names = {}; ///< of each part, for errors; may be ""
    std::vector<bool> supports = {};     ///< true for each part that is a support
    /// A number for each part; parts of a number that overlap are united before scan vectors are made.
    std::vector<std::uint32_t> objects = {};
    /// Index of the file of each part, in ascending order, and then of each negative volume. If it is empty,
    /// all bodies belong to the first file.
    std::vector<std::uint32_t> files = {};
    std::vector<PlateNegative> negatives = {};
    Rounding rounding = {}; ///< of the coordinates of the layers
    Rounding written = {};  ///< of the coordinates in the output
    bool of_mesh = true;    ///< false for the layers of a slice file, whose findings have other cures

    std::optional<double> close_gaps_mm = {}; ///< see RepairPolicies
    LayerSteps steps = {};
    std::optional<ScanStrategy> scan = {};
    std::optional<PrintCheckOptions> check = {};
    std::uint32_t image_cuts = 1; ///< see FileJob
    bool statistics = false;      ///< measures and hashes every layer
    LayerLimits limits = {};
};

} // namespace lamella
