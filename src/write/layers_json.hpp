#pragma once

// Everything that layers have, as JSON. docs/formats.md describes it.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter>
open_layers_json(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options);

} // namespace lamella
