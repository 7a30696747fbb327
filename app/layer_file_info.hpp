#pragma once

// What the head of a slice file says, for layers that were read from another one.

#include "lamella/read/layer_file.hpp"
#include "lamella/write/layer_writer.hpp"

namespace lamella::app {

/// Parts without a label are called as PartInfo calls them. The box reaches from the bottom of the first
/// layer to the top of the last. Throws Error{input} for a file without layers.
[[nodiscard]] LayerFileInfo info_of(const LayerFile& file);

} // namespace lamella::app
