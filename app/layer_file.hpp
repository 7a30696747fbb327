#pragma once

// Layers that were read from a slice file: what is said and asked of them before they are written again.

#include "lamella/polygon/layer_steps.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/write/layer_writer.hpp"

#include "messages.hpp"

#include <string>
#include <vector>

namespace lamella::app {

/// Parts without a label are called as PartInfo calls them. The box reaches from the bottom of the first
/// layer to the top of the last. Throws Error{input} for a file without layers.
[[nodiscard]] LayerFileInfo info_of(const LayerFile& file);

/// Tells what is odd about the file, or lost of it. For --strict: throws Error{defect} with the first of it.
void tell(const LayerFile& file, const std::vector<std::string>& warnings, bool strict, Messages& messages);

/// What steps changed.
struct StepChanges {
    std::vector<LayerChanges> planes;
    LayerChanges all;
};

/// Takes the steps, and tells as above of rings that bound no material, of hatch lines that are left out with
/// the contours that they fill, and where no contour is left. Throws Error{usage} for steps on scan vectors:
/// hatches are other parts than their contours, which would be moved alone. `memory`: as of
/// lamella::take_steps.
StepChanges take_steps(const LayerSteps& steps, LayerFile& file, bool strict, Messages& messages,
                       const Execution& execution, std::uint64_t memory);

} // namespace lamella::app
