#pragma once

// Layers from a slice file: their messages and steps before they are written again.

#include "lamella/polygon/layer_steps.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/write/layer_writer.hpp"

#include "messages.hpp"

#include <string>
#include <vector>

namespace lamella::app {

/// Returns the header. Parts without a label get the default of PartInfo. The box extends from the bottom of
/// the first layer to the top of the last. Throws Error{input} for a file without layers.
[[nodiscard]] LayerFileInfo info_of(const LayerFile& file);

/// Prints the warnings of the file, and its lost content. With `strict`, throws Error{defect} with the first
/// one.
void warn_about(const LayerFile& file, const std::vector<std::string>& warnings, bool strict,
                Messages& messages);

struct StepChanges {
    std::vector<LayerChanges> planes;
    LayerChanges all;
};

/// Takes the steps. Reports as above rings that bound no material, hatch lines that are dropped together with
/// the contours that they fill, and results without contours. Throws Error{usage} for steps on scan vectors:
/// hatches and their contours are different parts, and only contours would be offset. `max_memory` is that of
/// lamella::take_steps.
StepChanges take_steps(const LayerSteps& steps, LayerFile& file, bool strict, Messages& messages,
                       const Execution& execution, std::uint64_t max_memory);

} // namespace lamella::app
