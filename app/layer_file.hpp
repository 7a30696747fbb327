#pragma once

// Layers that were read from a slice file: messages about them, and steps before they are written again.

#include "lamella/polygon/layer_steps.hpp"
#include "lamella/slices/layer_file.hpp"
#include "lamella/slices/layer_writer.hpp"

#include "messages.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace lamella::app {

/// Prints the warnings of the file and about its lost content. With `strict`, throws Error{defect} with the
/// first warning instead.
void warn_about(const LayerFile& file, const std::vector<std::string>& warnings, bool strict,
                Messages& messages);

struct StepChanges {
    std::vector<LayerChanges> planes;
    LayerChanges all;
};

/// Applies the steps by lamella::take_steps. Warns like warn_about of rings that bound no material, of hatch
/// lines that are dropped together with the contours that they fill, and of results without contours.
StepChanges take_steps(const LayerSteps& steps, LayerFile& file, bool strict, Messages& messages,
                       const Execution& execution, std::uint64_t max_memory);

/// Throws Error{usage} for options that concern meshes alone.
[[noreturn]] void refuse_options_of_meshes(const LayerFile& file);

/// Writes all layers of the file, which need not be in memory. If `search_rings`, warns like take_steps of
/// rings that bound no material. `max_memory` is that of layer_doubts.
void write_planes(LayerWriter& writer, const LayerFile& file, bool search_rings, bool strict,
                  Messages& messages, const Execution& execution, std::uint64_t max_memory);

} // namespace lamella::app
