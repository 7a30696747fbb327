#pragma once

// 3MF with slice stacks (3MF Slice Extension).

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter> open_slices_3mf(const std::string& path, const LayerFileInfo& info,
                                                           const LayerWriteOptions& options);

} // namespace lamella
