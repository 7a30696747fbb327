#pragma once

// Layers that were read from a slice file: what is said and asked of them before they are written again.

#include "lamella/polygon/layer_steps.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/write/layer_writer.hpp"

#include <string>
#include <vector>

namespace lamella::app {

/// Parts without a label are called as PartInfo calls them. The box reaches from the bottom of the first
/// layer to the top of the last. Throws Error{input} for a file without layers.
[[nodiscard]] LayerFileInfo info_of(const LayerFile& file);

/// For --strict: throws Error{defect} with the first warning of the file, if it has any.
void check_warnings(const LayerFile& file);

/// Throws Error{usage} for steps on scan vectors: hatches are other parts than their contours, which would be
/// moved alone.
void check_no_vectors(const LayerFile& file, const LayerSteps& steps);

/// Takes the steps; the changes of each plane.
[[nodiscard]] std::vector<LayerChanges> take_steps(const LayerSteps& steps, LayerFile& file,
                                                   const Execution& execution);

/// A warning about hatch lines that the steps left out; "" where there are none.
[[nodiscard]] std::string lost_hatches(const LayerFile& file, const LayerChanges& changes);

} // namespace lamella::app
