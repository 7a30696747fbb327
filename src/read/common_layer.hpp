#pragma once

// Common Layer Interface files whose layers are made later: the heights of all files of an archive are tops
// of layers, or those of all are bottoms.

#include "lamella/core/execution.hpp"
#include "lamella/read/layer_file.hpp"

#include "read/layer_assembly.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lamella {

struct CommonLayerContent {
    LayerFile file;               ///< its parts have no layers yet
    std::vector<RawLayer> layers; ///< ascending, one at least
    std::uint64_t bytes = 0;
    double lowest = 0;      ///< bottom of the part
    bool on_bottom = false; ///< the first layer lies there and has contours
};

/// What a part is of, by its label and by what it holds: contours and no hatch lines, or else.
using ExposureOfPart = std::function<std::optional<Exposure>(std::string_view label, VectorKind held)>;

[[nodiscard]] CommonLayerContent read_common_layer_content(std::string_view bytes, const std::string& name,
                                                           const ExposureOfPart& exposure_of,
                                                           ReadLimits& limits, const Execution& execution);

/// Heights are tops of layers. Exports exist whose first layer lies on the bottom of the part and has
/// contours: there they are bottoms, and those of all files are returned, ascending; such that are no further
/// apart than `same` are one.
[[nodiscard]] std::vector<double> bottoms_of(std::span<const CommonLayerContent> files, double same,
                                             ReadLimits& limits);

/// `bottoms` as above. Where there are none, an empty layer before the first one tells where that begins.
[[nodiscard]] LayerFile layers_of(CommonLayerContent content, std::span<const double> bottoms,
                                  ReadLimits& limits);

} // namespace lamella
