#pragma once

// ILT: Common Layer Interface files in a zip archive, with the parameters of each. There is no published
// description; files of several programs agree in what docs/formats.md tells.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter> open_ilt(const std::string& path, const LayerFileInfo& info,
                                                    const LayerWriteOptions& options);

} // namespace lamella
