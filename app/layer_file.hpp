#pragma once

// Layers that were read from a slice file: messages about them, and steps before they are written again.

#include "lamella/polygon/layer_steps.hpp"
#include "lamella/read/layer_file.hpp"
#include "lamella/write/layer_writer.hpp"

#include "messages.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lamella::app {

/// Returns the header. Parts without a label get the default of PartInfo. The box extends from the bottom of
/// the first layer to the top of the last. Throws Error{input} for a file without layers.
[[nodiscard]] LayerFileInfo info_of(const LayerFile& file, const Execution& execution);

/// Prints the warnings of the file and about its lost content. With `strict`, throws Error{defect} with the
/// first warning instead.
void warn_about(const LayerFile& file, const std::vector<std::string>& warnings, bool strict,
                Messages& messages);

/// Returns the layers that stay in memory if the steps are taken. Steps on layers that do not stay are taken
/// twice.
[[nodiscard]] LayersKept layers_kept(const LayerSteps& steps);

struct StepChanges {
    std::vector<LayerChanges> planes;
    LayerChanges all;
};

/// Applies the steps by lamella::take_steps. Warns like warn_about of rings that bound no material, of hatch
/// lines that are dropped together with the contours that they fill, and of results without contours.
StepChanges take_steps(const LayerSteps& steps, LayerFile& file, bool strict, Messages& messages,
                       const Execution& execution, std::uint64_t max_memory);

/// Writes all layers of the file, which need not be in memory. If `search_rings`, warns like take_steps of
/// rings that bound no material. `max_memory` is that of layer_doubts.
void write_planes(LayerWriter& writer, const LayerFile& file, bool search_rings, bool strict,
                  Messages& messages, const Execution& execution, std::uint64_t max_memory);

} // namespace lamella::app
