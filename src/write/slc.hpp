#pragma once

// SLC 2.0 of 3D Systems, binary.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter> open_slc(const std::string& path, const LayerFileInfo& info,
                                                    const LayerWriteOptions& options);

} // namespace lamella
