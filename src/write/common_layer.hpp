#pragma once

// Common Layer Interface 2.0, ASCII and binary.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter>
open_common_layer_ascii(const std::string& path, const LayerFileInfo& info, const LayerWriteOptions& options);

[[nodiscard]] std::unique_ptr<LayerWriter> open_common_layer_binary(const std::string& path,
                                                                    const LayerFileInfo& info,
                                                                    const LayerWriteOptions& options);

} // namespace lamella
