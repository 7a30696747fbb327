#pragma once

// NumPy arrays in a zip archive, as numpy.load reads them. docs/formats.md lists them.

#include "lamella/write/layer_writer.hpp"

#include <memory>
#include <string>

namespace lamella {

[[nodiscard]] std::unique_ptr<LayerWriter> open_npz(const std::string& path, const LayerFileInfo& info,
                                                    const LayerWriteOptions& options);

} // namespace lamella
