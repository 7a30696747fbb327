#pragma once

// 3MF with toolpaths (3MF Toolpath Extension 1.0, a release candidate).

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter>
open_toolpath_3mf(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options);

} // namespace lamella
