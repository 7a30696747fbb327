#pragma once

// SVG: one file with all layers, as Slic3r writes it, or one picture per layer.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter>
open_layered_svg(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options);

/// A folder with `layer_00000.svg` and so on, numbered by Layer::index.
[[nodiscard]] std::unique_ptr<LayerWriter> open_svg_layers(const std::string& path, const LayerFileInfo& info,
                                                           const LayerWriteOptions& options);

} // namespace lamella
