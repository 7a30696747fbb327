#pragma once

// Reads Common Layer Interface files. Their layers are made later, because in an archive either the heights
// of all files are tops of layers, or all are bottoms.

#include "lamella/core/execution.hpp"
#include "lamella/slices/layer_file.hpp"

#include "slices/engine/layer_assembly.hpp"

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
    std::vector<RawLayer> layers; ///< ascending, at least one
    ParseLayer parse;
    std::uint64_t bytes = 0;
    double lowest = 0;      ///< height of the bottom of the part
    bool on_bottom = false; ///< the first layer is at `lowest` and has contours
};

/// Returns the exposure of a part from its label and its kind, which is contour if it has contours and no
/// hatch line, otherwise hatch.
using ExposureOfPart = std::function<std::optional<Exposure>(std::string_view label, VectorKind held)>;

/// `bytes` must outlive `parse`.
[[nodiscard]] CommonLayerContent read_common_layer_content(std::string_view bytes, const std::string& name,
                                                           const ExposureOfPart& exposure_of,
                                                           ReadLimits& limits, const Execution& execution);

/// Returns the heights of all files, ascending, if they are bottoms of layers; heights at most `same` apart
/// are merged. Returns an empty list if they are tops, as usual. They are bottoms if the first layer of a
/// file is on the bottom of the part and has contours, as in some exports.
[[nodiscard]] std::vector<double> bottoms_of(std::span<const CommonLayerContent> files, double same,
                                             ReadLimits& limits);

/// Makes the layers; `bottoms` is the result of bottoms_of. If it is empty, a layer without contours at the
/// beginning specifies the bottom of the layer after it.
[[nodiscard]] LayerFile layers_of(CommonLayerContent content, std::span<const double> bottoms,
                                  ReadLimits& limits, const Execution& execution);

} // namespace lamella
